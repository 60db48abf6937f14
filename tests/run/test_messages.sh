#!/bin/sh
# SPDX-License-Identifier: MIT
# The programs' messages about bad input: exact lines. Each is `program: place: what is wrong: what was expected`,
# whatever bytes files, names and values have.
. tests/support/claims.sh
here=$PWD
cd "$work" || exit 1
case $bin in /*) ;; *) bin=$here/$bin ;; esac
cp "$here/assets/fur.tfx" "$here/assets/ball.obj" .

# line STATUS TEXT PROGRAM ARGUMENT...: exits with the status and prints this one line.
line() {
    expected=$1 text=$2 name=$3; shift 3
    "$bin/tractrix-$name" "$@" >out 2>err </dev/null
    status=$?
    printf 'tractrix-%s: %s\n' "$name" "$text" >wanted
    if [ $status = "$expected" ] && cmp -s wanted err; then good; else bad "status $status, expected $expected and: $text"; fi
}
# scene KEYS TEXT: a scene file with these keys is refused with this text.
scene() { printf '{"sections": [{"file": "fur.tfx"}], %b}' "$1" >s.json; line "${3:-3}" "s.json: $2" render s.json; }
escape=$(printf '\033') c1=$(printf '\302\233') bad=$(printf '\377') left=$(printf '\342\200\256')

claim "values out of range name their limits"
line 2 "--color-variation: got '-1e30', expected a number from 0 to 1 (nearest: 0)" render fur.tfx --color-variation -1e30
line 2 "--frames: got '99999999999999999999', expected a whole number from 1 to 10000000 (nearest: 10000000)" render fur.tfx --frames 99999999999999999999
line 2 "--frames: got '', expected a whole number from 1 to 10000000" render fur.tfx --frames ''
line 2 "--fov: got 'nan', expected a number from 1 to 170 (deg)" render fur.tfx --fov nan
line 2 "--style: got '0:-1e30', expected a number from 0 to 1, or two such numbers, ROOT:TIP" render fur.tfx --style 0:-1e30
line 2 "--colliders: sphere: got -1e+30, expected numbers from -1000000 to 1000000" render fur.tfx --colliders sphere:0,0,0,-1e30
line 2 "--colliders: sphere: got the radius -1, expected a number from 0 to 1000000" render fur.tfx --colliders sphere:0,0,0,-1
line 2 "--scale: got '-1e30', expected a number from 1e-9 to 1e9" convert fur.tfx --scale -1e30 -o y.tfx
line 2 "--count: got '-1e30', expected a whole number from 1 to 10000000" gen --count -1e30 -o g.tfx
line 2 "--pixel-tolerance: got '-1e30', expected a number from 0 to 255" compare --pixel-tolerance -1e30 a b
line 2 "--rates: got '0', expected up to 8 numbers from 1 to 1000000 with commas between them" bench speed --rates 0
scene '"fps": -1e30' "fps: got '-1e+30', expected a number from 0.001 to 10000 (1/s), or a fraction, 24000/1001 (nearest: 0.001)"
scene '"head": {"keys": [{"time": -1e30, "translate": [0, 0, 0]}]}' "head.keys[0].time: got -1e30, expected seconds from -1000000000 to 1000000000 (nearest: -1000000000)"
scene '"colliders": [{"sphere": [0, 0, 0, -1]}]' "colliders[0]: sphere: got the radius -1, expected a number from 0 to 1000000"

claim "a corner of a mesh that is no vertex has its place"
{ printf 'ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n'
  printf 'element face 1\nproperty list uchar int vertex_indices\nend_header\n'; head -c 36 /dev/zero; } >start.ply
{ cat start.ply; printf '\003\0\0\0\0\001\0\0\0\377\377\377\377'; } >below.ply
{ cat start.ply; printf '\003\0\0\0\0\001\0\0\0\003\0\0\0'; } >above.ply
line 3 "below.ply: byte 218: -1 in a list: expected a whole number from 0" render fur.tfx -q --mesh below.ply -o d.png
line 3 "above.ply: byte 218: face 0 has corner 3: expected less than 3" render fur.tfx -q --mesh above.ply -o d.png

claim "a device that does not exist is told, and no other failure"
line 4 "--device 99: no such device: there are fewer (see --list-devices)" render fur.tfx -q --device 99 -o d.png

claim "a formula's mistake has its place"
scene '"head": {"translate": ["t +", "0", "0"]}' "head.translate[0]: got 't +', expected a formula of t: unexpected end of expression at character 4"
scene '"head": {"rotate": ["0", "2 * foo(t)", "0"]}' "head.rotate[1]: got '2 * foo(t)', expected a formula of t: unexpected token \"foo\" at character 5"
scene '"head": {"translate": ["0", "0", "(t"]}' "head.translate[2]: got '(t', expected a formula of t: missing parenthesis at character 3"
scene '"head": {"translate": ["1,2", "0", "0"]}' "head.translate[0]: got '1,2', expected a formula of t: more than one value, and a decimal point is '.'"
scene '"head": {"translate": ["", "0", "0"]}' "head.translate[0]: got '', expected a formula of t: expression is empty"

claim "line ends, escapes and other bytes of names and files are shown, not sent"
odd=$(printf 'no\nfile%s[31m' "$escape")
line 3 'no\nfile\x1b[31m: No such file or directory' convert "$odd"
line 3 '\xc2\x9b1m\xff\xe2\x80\xaex: No such file or directory' convert "${c1}1m$bad${left}x"
line 2 "--frames: got '3\n4', expected a whole number from 1 to 10000000" render fur.tfx --frames "$(printf '3\n4')"
line 2 '--\x1b[2J: no such option: see --help' render "--${escape}[2J"
line 2 "--kind: got '\x1b', expected random, straight, curls or fur" gen --kind "$escape" -o g.tfx
scene '"bad\\u001bkey\\n%s": 1' 'unknown key '"'"'bad\x1bkey\n%s'"'"': expected a key of --help schema'
scene '"frames": "\\n\\u009b"' "frames: got \"\\n\xc2\x9b\", expected a whole number from 1 to 10000000"
printf '{"a\033": ' >t.json; line 3 "t.json:1:4: a control character in a string: expected an escape such as \\n" render t.json
mkdir "$odd.d"; line 3 'no\nfile\x1b[31m.d: Is a directory' convert "$odd.d"
printf 'v 0 0 \033[31m\n' >c.obj; line 3 "c.obj:1: expected a vertex's coordinate, got '\x1b[31m'" render fur.tfx --mesh c.obj --frames 1 -q -o x.png

claim "a long path is shortened in its middle, so that the reason stays"
long=$(head -c 200 /dev/zero | tr '\0' d) path=.
for part in 1 2 3 4 5 6 7 8 9; do path=$path/$long$part; done
mkdir -p "$path" && cp fur.tfx "$path/last.tfx" && head -c 100 fur.tfx >"$path/cut.tfx"
"$bin/tractrix-convert" "$path/none.tfx" 2>err; one_line; says "./ddd"; says "d9/none.tfx: No such file or directory"
"$bin/tractrix-render" "$path/cut.tfx" -q --frames 1 -o x.png 2>err; one_line; says "d9/cut.tfx: byte"
"$bin/tractrix-convert" fur.tfx -q -o "$path/$long$long.tfx" 2>err; one_line; says "File name too long"
"$bin/tractrix-convert" "$path/last.tfx" -o "$path/last.tfx" 2>err; one_line; says "would overwrite"

claim "a byte-order mark before text is no mistake"
marked() { (printf '\357\273\277'; cat "$1") >"marked.$1"; }
printf '{"sections": [{"file": "fur.tfx"}], "frames": 1, "size": "16x12"}' >good.json; cp good.json good_scene
marked good.json; holds "$bin/tractrix-render" marked.good.json --check
marked good_scene; holds "$bin/tractrix-render" marked.good_scene --check
marked ball.obj; holds "$bin/tractrix-gen" fur marked.ball.obj --count 10 -q -o furred.tfx
for suffix in usda obj ply tfx; do
    kind=; case $suffix in tfx) kind="--format text" ;; ply) kind="--format ply-text" ;; esac
    # shellcheck disable=SC2086
    holds "$bin/tractrix-convert" fur.tfx -q $kind -o "hair.$suffix"
    marked "hair.$suffix"
    holds "$bin/tractrix-convert" "hair.$suffix" -q --unit m --up y -o one.data
    holds "$bin/tractrix-convert" "marked.hair.$suffix" -q --unit m --up y -o two.data
    equal one.data two.data
done
printf 'solver,ms\nsplit,2\n' >step.csv
marked step.csv; holds "$bin/tractrix-bench" page marked.step.csv --html page.html
in_file page.html '"solver"'
for text in '' '\0357\0273\0277' '\0000'; do
    printf %b "$text" >none.csv; line 3 "none.csv: is empty: expected a line with the names of the columns" bench page none.csv --html none.html
done

claim "bad PNG files have a reason that can be read"
holds "$bin/tractrix-render" good.json -q --algo none --scalp none -o good.png
printf '' >p.png; line 3 "p.png: not a PNG file" compare p.png good.png
for bytes in 8 20 33 50; do head -c $bytes good.png >p.png; line 3 "p.png: not a readable PNG file: it ends too early" compare p.png good.png; done
at() { cp good.png p.png; printf '\377' | dd of=p.png bs=1 seek="$1" conv=notrunc 2>/dev/null; line 3 "p.png: not a readable PNG file: $2" compare p.png good.png; }
at 12 '[FF]HDR: invalid chunk type'
at 29 'IHDR: CRC error'
at 37 '[FF]EXt: invalid chunk type'

claim "a line says what a file has of a look and what of it is used, --check what it carries"
{
    printf 'ply\nformat ascii 1.0\nelement vertex 4\n'
    printf 'property float %s\n' x y z red green blue alpha thickness
    printf 'element strand 2\nproperty int nsegs\nend_header\n'
    for x in 0 0.1; do printf '%s 0 0 1 0 0 0.5 0.01\n%s 0.1 0 1 0 0 0.5 0.01\n' $x $x; done
    printf '1\n1\n'
} >look.ply
# look TEXT FLAG...: compares the first line that the program prints.
look() { text=$1; shift; "$bin/tractrix-render" look.ply --unit m --algo none --look plain --frames 1 --size 8x8 -o look.png "$@" 2>err; if [ "$(head -n 1 err)" = "look.ply: the file's $text" ]; then good; else bad "got '$(head -n 1 err)', expected: $text"; fi; }
look "colours used (--file-colors), opacities used (--file-opacity), thickness used (--file-thickness)"
look "colours not used (--file-colors), opacities used (--file-opacity), thickness used (--file-thickness)" --color '#0000ff'
look "colours used (--file-colors), opacities not used (--file-opacity), thickness not used (--file-thickness)" --opacity 0.5 --no-file-thickness
"$bin/tractrix-render" look.ply --check >out 2>&1
if grep -q '^  carries   thickness of vertices, colours, opacities$' out; then good; else bad "$(cat out)"; fi
"$bin/tractrix-convert" look.ply >out 2>&1
if grep -q '^  carries   thickness of vertices, colours, opacities$' out; then good; else bad "$(cat out)"; fi
"$bin/tractrix-render" fur.tfx --check >out 2>&1
if grep -q '^  carries   texture coordinates of strands$' out; then good; else bad "$(cat out)"; fi
"$bin/tractrix-render" fur.tfx --algo none --frames 1 --size 8x8 -o look.png 2>err
if grep -q "the file's" err; then bad "$(cat err)"; else good; fi

finish
