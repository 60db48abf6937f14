#!/bin/sh
# SPDX-License-Identifier: MIT
# `make install`: files in their places, programs that work without the checkout, manual pages, versions, and shaders
# read from a folder.
. tests/support/claims.sh
program=$bin/tractrix-render
bin_here=$(realpath "$bin")
root=$work/root share=$work/root/usr/share

# The programs have been built by whoever runs the tests; with the same flags, make does not build them again.
same="OUT=$(realpath --relative-to=. "$bin")" compiler=$(sed 's/ -std=.*//; q' "$bin/flags")
if grep -q fsanitize "$bin/flags"; then same="$same CONFIG=sanitize"; else same="$same CONFIG=release"; fi
if grep -q -- -Werror "$bin/flags"; then same="$same WERROR=1"; else same="$same WERROR="; fi
installs() {
    # shellcheck disable=SC2086
    holds make --no-print-directory "$1" "CC=$compiler" $same DESTDIR="$root" PREFIX=/usr
    if grep -qE '^  (CC|LINK) ' "$work/out"; then bad "built anew"; else good; fi
}
claim "make install puts everything under DESTDIR and PREFIX"
installs install
for name in render gen convert compare bench farm turntable compare-goldens; do
    name=tractrix-$name
    is_file "$root/usr/bin/$name"; is_file "$share/man/man1/$name.1"; is_file "$share/bash-completion/completions/$name"
    is_file "$share/fish/vendor_completions.d/$name.fish"; is_file "$share/zsh/site-functions/_$name"
done
if [ "$(find "$root/usr/bin" -type f | wc -l)" = 8 ]; then good; else bad "not 8 programs: $(ls "$root/usr/bin")"; fi
for file in include/tractrix.h lib/libtractrix.so.0 lib/libtractrix.a lib/pkgconfig/tractrix.pc lib/cmake/tractrix/tractrix-config.cmake; do is_file "$root/usr/$file"; done
holds test "$(readlink "$root/usr/lib/libtractrix.so")" = libtractrix.so.0
for file in man/man1/tractrix-gen-fur.1 doc/tractrix/LICENSE doc/tractrix/docs/look.md doc/tractrix/docs/notes/solvers.md tractrix/demo.json tractrix/scene.schema.json; do
    is_file "$share/$file"
done
# Every example of the checkout; programs must be executable.
for file in $(git ls-files examples 2>/dev/null); do equal "$file" "$share/doc/tractrix/$file"; done

claim "an installed program needs nothing of the checkout"
program=$root/usr/bin/tractrix-render
cd "$work" || exit 1
run 0 "$share/tractrix/demo.json" --frames 1 --preroll 0 --exposure 0 --size 64x48 -q -o "$work/installed/"
program=$root/usr/bin/tractrix-turntable
export TURNTABLE_S=0.1 TURNTABLE_OUT="$work/turn"
run 0 "$share/tractrix/fur.tfx" frames --size 48x32 --quality draft --look plain --preroll 0 -q
unset TURNTABLE_S TURNTABLE_OUT
program=$root/usr/bin/tractrix-farm
run 0 -n 2 plain -o "$work/farm/" "$share/tractrix/fur.tfx" --frames 2 --look plain --size 48x32 -q
program=$root/usr/bin/tractrix-compare-goldens
printf 'fur %s --frames 1 --look plain --size 48x32\n' "$share/tractrix/fur.tfx" >"$work/list"
run 0 "$work/list" "$work/goldens/" "$work/compared/" --update
run 0 "$work/list" "$work/goldens/" "$work/compared/"
for name in farm turntable compare-goldens; do
    program=$root/usr/bin/tractrix-$name
    run 0 --version; says "tractrix-$name $(sed -n 's/.*TRACTRIX_VERSION "\(.*\)"/\1/p' "$bin_here/version.h")"; silent err
    run 0 --help; says "Usage: tractrix-$name "; silent err
done
# The scenes of the docs find the assets.
program=$root/usr/bin/tractrix-render
run 0 "$share/doc/tractrix/docs/floor.json" --check
program=$root/usr/bin/tractrix-render
cd - >/dev/null || exit 1
is_file "$work/installed/frame_0000.png"; is_file "$work/turn/fur/frame_0000.png"; is_file "$work/farm/frame_0001.png"; is_file "$work/goldens/fur.png"

# With sanitizers, their libraries would have to be loaded first.
claim "30 lines of C against the installed library draw what tractrix-render draws"
if grep -q fsanitize "$bin/flags"; then
    skip "libraries of a sanitizer's build"
else
    # Smaller than in the page: 160x120.
    awk '/^```/ { inside = $0 == "```c" && !seen++; next } inside' docs/library.md | sed 's/640/160/g; s/480/120/g' >"$work/first.c"
    export PKG_CONFIG_PATH="$root/usr/lib/pkgconfig" PKG_CONFIG_SYSROOT_DIR="$root"
    # shellcheck disable=SC2046 # words
    holds cc -o "$work/first" "$work/first.c" $(pkg-config --cflags --libs tractrix)
    holds cc -o "$work/uninstalled" "$work/first.c" -Isrc/library -L"$bin/lib" -Wl,-rpath,"$bin_here/lib" -ltractrix # in the checkout
    (cd "$work" && LD_LIBRARY_PATH="$root/usr/lib" ./first "$share/tractrix/fur.tfx") >"$work/out" 2>"$work/err"
    run 0 "$share/tractrix/fur.tfx" --size 160x120 -q -o "$work/rendered.png"
    holds "$bin_here/tractrix-compare" "$work/first.png" "$work/rendered.png"
    if command -v cmake >/dev/null; then
        mkdir "$work/cmake"; cp "$work/first.c" "$work/cmake/"
        awk '/^```cmake/ { inside = 1; next } /^```/ { inside = 0 } inside' docs/library.md >"$work/cmake/CMakeLists.txt"
        holds cmake -S "$work/cmake" -B "$work/cmake/build" -DCMAKE_PREFIX_PATH="$root/usr"
        holds cmake --build "$work/cmake/build"
        holds "$work/cmake/build/first" "$share/tractrix/fur.tfx"; rm -f first.png
    else
        skip "no cmake"
    fi
    # shellcheck disable=SC2046
    holds cc -o "$work/static" "$work/first.c" -I"$root/usr/include" "$root/usr/lib/libtractrix.a" \
        $(PKG_CONFIG_SYSROOT_DIR='' pkg-config --libs $(pkg-config --print-requires-private tractrix)) \
        $(sed -n 's/^Libs.private: //p' "$PKG_CONFIG_PATH/tractrix.pc")
    rm -f "$work/first.png"
    (cd "$work" && ./static "$share/tractrix/fur.tfx") >"$work/out" 2>"$work/err"
    holds "$bin_here/tractrix-compare" "$work/first.png" "$work/rendered.png"
fi

claim "programs that draw nothing need no library of OpenGL"
for name in gen convert compare; do
    if ! readelf -d "$root/usr/bin/tractrix-$name" >"$work/out" 2>"$work/err"; then skip "no readelf"
    elif grep -qiE 'NEEDED.*(epoxy|EGL|GL)' "$work/out"; then bad "$name: $(grep -iE 'epoxy|GL' "$work/out")"
    else good; fi
done

claim "ldconfig runs where the folder is one of the system's, and nowhere else"
mkdir "$work/fake"
# shellcheck disable=SC2016 # of the script that it writes
printf '#!/bin/sh\necho "%s/home/lib: (from a file)"\n[ "$1" = -N ] || echo ran >"%s/ran"\n' "$work" "$work" >"$work/fake/ldconfig"
chmod 755 "$work/fake/ldconfig"
for home in other home; do
    none "$work/ran"
    # shellcheck disable=SC2086
    holds env -u PKG_CONFIG_PATH -u PKG_CONFIG_SYSROOT_DIR PATH="$work/fake:$PATH" make --no-print-directory install "CC=$compiler" $same PREFIX="$work/$home" LIBDIR="$work/$home/lib"
done
is_file "$work/ran"

claim "manual pages are sound"
for page in "$share"/man/man1/*; do
    in_file "$page" '.SH "'
    name=$(basename "$page" .1 | tr '[:lower:]' '[:upper:]')
    in_file "$page" ".TH $name 1"
    if command -v man >/dev/null; then
        holds man -l -Tutf8 --warnings=w "$page"
        silent err
    else
        skip "no man"
    fi
done

claim "make uninstall leaves no file behind"
installs uninstall
holds test -z "$(find "$root" ! -type d)"
# Folders of the project and of completions are removed, too; folders of the system stay.
holds test "$(cd "$root" && find . -type d | sort | tr '\n' ' ')" = ". ./usr ./usr/bin ./usr/include ./usr/lib ./usr/lib/cmake ./usr/lib/pkgconfig ./usr/share ./usr/share/doc ./usr/share/man ./usr/share/man/man1 "

claim "the version sorts as Debian's do"
program=$bin/tractrix-render
run 0 --version
version=$(cut -d' ' -f2 "$work/out")
if command -v dpkg >/dev/null; then
    holds dpkg --validate-version "$version"
    holds dpkg --compare-versions "$version" le "$(sed -n 's/^VERSION := //p' Makefile)"
else
    skip "no dpkg"
fi

claim "TRACTRIX_GLSL_DIR gives other shaders, and tells what is wrong with them"
cp -r glsl "$work/glsl"
run 0 assets/fur.tfx --frames 1 --look plain --size 64x48 -q -o "$work/own.png"
TRACTRIX_GLSL_DIR=$work/glsl
export TRACTRIX_GLSL_DIR
run 0 assets/fur.tfx --frames 1 --look plain --size 64x48 -q --stats "$work/stats.json" -o "$work/same.png"
equal "$work/own.png" "$work/same.png"
in_file "$work/stats.json" "$TRACTRIX_GLSL_DIR"
chmod u+w "$work/glsl/draw/block_project.comp"
sed 's/^void main()/this is no GLSL\n&/' glsl/draw/block_project.comp >"$work/glsl/draw/block_project.comp"
run 1 assets/fur.tfx --frames 1 --look plain --size 64x48 --raster compute -q -o "$work/none.png"
says "block_project.comp:$(grep -n '^this' "$work/glsl/draw/block_project.comp" | cut -d: -f1)"; one_line
none "$work/none.png"
rm "$work/glsl/draw/block_project.comp"
run 3 assets/fur.tfx --frames 1 --look plain --size 64x48 --raster compute -q -o "$work/none.png"; says "block_project.comp"; one_line
none "$work/none.png"

finish
