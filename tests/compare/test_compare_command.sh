#!/bin/sh
# SPDX-License-Identifier: MIT
# The command line of tractrix-compare in CI: every exit status, messages, files.
. tests/support/claims.sh
program=$bin/tractrix-compare
golden=tests/golden

a=$golden/curls_still.png b=$golden/curls_split.png other=$golden/fur_transparent.png

claim "an image is the same as itself"
run 0 $a $a; says "same: RMSE 0, PSNR inf dB, SSIM 1, FLIP 0"; says "1 image: 1 same"; silent err
run 0 $other $other
run 0 -q $a $a; silent out; silent err

claim "different images give status 1"
run 1 $a $b; says "different: RMSE"; says "1 different; largest RMSE"; silent err
if grep -qE "SSIM|FLIP" "$work/out"; then bad "figures that no limit needs"; else good; fi
run 1 $a $b --all-metrics; says "SSIM 0."; says "1 different; largest FLIP"
run 1 -q $a $b; silent out; silent err
run 1 $a $other; says "size mismatch: 160 x 120 and 128 x 128 pixels"

claim "each limit alone decides"
run 0 $a $b --pixel-tolerance 255
run 1 $a $b --pixel-tolerance 8
run 0 $a $b --max-failing-pixels 100%
run 0 $a $b --max-failing-pixels 19200
run 1 $a $b --max-failing-pixels 1
run 0 $a $b --max-flip 0.9
run 1 $a $b --max-flip 0.01
run 1 $a $b --max-flip 0.9 --max-failing-pixels 1

claim "wrong usage is status 2 and one line"
run 2 $a $a --json - --html -; one_line; says "2 reports to standard output: expected at most one"; silent out
run 2 $a $a --json - --junit - --html -; one_line; says "3 reports to standard output"; silent out
for words in "" "$a" "$a $b $other" "--max-flip 2 $a $b" "--max-flip x $a $b" "--max-failing-pixels 1.5 $a $b" "--max-failing-pixels 101% $a $b" \
    "--max-failing-pixels -1 $a $b" "--pixel-tolerance 300 $a $b" "--ppd 0 $a $b" "-j 0 $a $b" "--jobs 1.5 $a $b" "--json= $a $b" "--bogus $a $b" \
    "$a $b --max-flip" "$golden $a" "--help=webpage" "--pixel-tolerance nan $a $b"; do
    # shellcheck disable=SC2086
    run 2 $words; one_line; silent out
done
run 2 --heatmpa x $a $b; says "did you mean '--heatmap'?"

claim "what can't be read is status 3, and named"
echo "no picture" >"$work/text.png"
head -c 3000 $a >"$work/cut.png"
for file in "$work/text.png" "$work/cut.png" "$work/missing.png"; do
    run 3 $a "$file"; says "$file"; one_line
    run 3 "$file" $a; says "$file"; one_line
done
run 3 "$work/nothing/" $golden; says "nothing"
mkdir "$work/empty"
run 3 "$work/empty" "$work/empty"; says "no images: expected .png, .pfm or .exr files"

claim "help and version are answered"
run 0 --help; says "--max-failing-pixels N|P%"; run 0 --help=man; says ".TH TRACTRIX-COMPARE 1"; run 0 --version; says "tractrix-compare "
"$program" --help >/dev/full 2>"$work/err"
if [ $? = 1 ]; then good; else bad "status with a full disk"; fi

claim "heat map and sheet are written, the same whatever else is asked"
run 1 $a $b --heatmap "$work/heat.png" --sheet "$work/sheet.png"; is_png "$work/heat.png"; is_png "$work/sheet.png"
run 1 "$work/heat.png" "$work/sheet.png"; says "160 x 120 and 488 x 120"
run 0 $a $a --heatmap "$work/black.png"; is_png "$work/black.png"
run 1 $a $b --heatmap "$work/heat.png/heat.png"; says "Not a directory"; one_line

claim "folders go frame by frame; what one lacks is missing"
mkdir "$work/a" "$work/b"
for i in 1 2 3 4; do cp $a "$work/a/f_$i.png"; cp $a "$work/b/f_$i.png"; done
run 0 "$work/a" "$work/b" --json "$work/report.json"; says "f_1.png: same"; says "4 images: 4 same"
sed -n 2p "$work/report.json" >"$work/verdict"; in_file "$work/verdict" '"good": true' # of all pairs
run 1 $a $b --json "$work/report.json"; sed -n 2p "$work/report.json" >"$work/verdict"; in_file "$work/verdict" '"good": false'
cp $b "$work/b/f_2.png"; rm "$work/b/f_3.png"; cp $other "$work/b/f_4.png"; cp $b "$work/b/f_5.png"
for jobs in 1 4; do
    run 1 "$work/a" "$work/b" -j $jobs --heatmap "$work/heats$jobs" --sheet "$work/sheets" --json "$work/report.json" --junit "$work/report.xml"
    says "f_2.png: different"; says "f_3.png: missing: no $work/b/f_3.png"; says "f_4.png: size mismatch"; says "f_5.png: new: no $work/a/f_5.png"
    says "5 images: 1 same, 1 different, 1 size mismatch, 1 new, 1 missing"
    is_png "$work/heats$jobs/f_2.png"; is_png "$work/sheets/f_2.png"; none "$work/heats$jobs/f_1.png"
    mv "$work/out" "$work/out$jobs"; : >"$work/out"
done
equal "$work/out1" "$work/out4"; equal "$work/heats1/f_2.png" "$work/heats4/f_2.png"
in_file "$work/report.json" '"outcome": "size mismatch"'; in_file "$work/report.json" '"missing": 1'; in_file "$work/report.json" '"psnr_db": null'
in_file "$work/report.xml" 'tests="5" failures="4" errors="0"'; in_file "$work/report.xml" '<failure type="missing"'
run 1 "$work/a/f_%d.png" "$work/b/f_%d.png"; says "5 images: 1 same, 1 different, 1 size mismatch, 1 new, 1 missing"

claim "a heat map or sheet that cannot be written makes its pair fail"
mkdir -p "$work/blocked/f_2.png"
for option in --heatmap --sheet; do
    run 1 "$work/a" "$work/b" $option "$work/blocked" --json "$work/report.json"
    says "f_2.png: failed: "; says "blocked/f_2.png: cannot write: Is a directory"; says "5 images: 1 same, 1 size mismatch, 1 new, 1 missing, 1 failed"
    in_file "$work/report.json" '"outcome": "failed"'
done

claim "one unreadable image among others is status 3, and they are still compared"
cp "$work/text.png" "$work/b/f_1.png"
run 3 "$work/a" "$work/b" --junit "$work/report.xml"; says "f_1.png: unreadable"; says "f_2.png: different"; one_line
in_file "$work/report.xml" 'errors="1"'; in_file "$work/report.xml" '<error type="unreadable"'

claim "--update takes what is readable and differs, to the byte, and nothing else"
cp "$work/text.png" "$work/a/f_6.png"; cp $b "$work/b/f_6.png"
run 3 "$work/a" "$work/b" --update; says "f_2.png: different"; says "reference updated"; says "4 references updated"
equal "$work/a/f_1.png" $a; equal "$work/a/f_2.png" $b; equal "$work/a/f_3.png" $a; equal "$work/a/f_4.png" $other; equal "$work/a/f_5.png" $b
equal "$work/a/f_6.png" $b
rm "$work/b/f_1.png" "$work/a/f_3.png" "$work/a/f_1.png"
run 0 "$work/a" "$work/b"
run 0 "$work/new/" "$work/b" --update; equal "$work/new/f_6.png" $b
run 0 "$work/new.png" $b --update; equal "$work/new.png" $b
: >"$work/plain"
run 1 "$work/plain/new.png" $b --update; one_line; says "plain/new.png"

claim "--update stays in the folder of the references"
mkdir -p "$work/kept/sub" "$work/beyond" "$work/rendered/sub"
cp $a "$work/beyond/f_1.png"; cp $a "$work/beyond/f_2.png"
for f in f_1 f_2 f_3; do cp $b "$work/rendered/$f.png"; done
ln -s ../beyond/f_1.png "$work/kept/f_1.png"; ln -s ../beyond/none.png "$work/kept/f_3.png"
run 1 "$work/kept" "$work/rendered" --update; says "f_1.png: is a symbolic link, which is not followed"; says "f_3.png: is a symbolic link"
equal "$work/beyond/f_1.png" $a; none "$work/beyond/none.png"; equal "$work/kept/f_2.png" $b
run 1 "$work/kept/f_%d.png" "$work/rendered/f_%d.png" --update; says "is a symbolic link, which is not followed"
equal "$work/beyond/f_1.png" $a
# The user may name a link: a single image, or the folder itself.
ln -s kept "$work/named"; rm "$work/kept"/f_*
run 0 "$work/named/" "$work/rendered" --update; equal "$work/kept/f_1.png" $b
ln -s beyond/f_2.png "$work/named.png"
run 0 "$work/named.png" $b --update; equal "$work/beyond/f_2.png" $b

claim "--shrink writes a small JPEG and nothing else"
run 0 --shrink 40 $a "$work/small.jpg"; silent out; silent err
if od -An -v -tx1 "$work/small.jpg" | tr -d ' \n' | grep -q '^ffd8.*ffc00011080\{2\}1e0028'; then good; else bad "not a JPEG of 40 x 30 pixels"; fi
run 2 --shrink 40 $a "$work/none.jpg" --max-flip 0.5; says "--max-flip: has no effect: --shrink compares nothing"; one_line; none "$work/none.jpg"
run 2 --shrink 40 $a "$work/none.jpg" --github; says "--github: has no effect"; none "$work/none.jpg"
run 2 --shrink 40 $a $a; one_line
run 3 --shrink 40 "$work/text.png" "$work/none.jpg"; one_line; none "$work/none.jpg"

claim "a reference without a new image is reported and left"
rm "$work/b/f_6.png"
run 1 "$work/a" "$work/b" --update; says "f_6.png: missing"; equal "$work/a/f_6.png" $b

claim "a reference whose heat map or sheet could not be written is left"
cp $a "$work/ref.png"
for option in --heatmap --sheet; do
    run 1 "$work/ref.png" $b --update $option "/proc/none/drawn.png"; one_line; says "none/drawn.png"; equal "$work/ref.png" $a
done
run 0 "$work/ref.png" $b --update --heatmap "$work/drawn.png"; says "reference updated"; equal "$work/ref.png" $b; is_png "$work/drawn.png"

claim "no report takes the place of an image that is compared, or of another report"
mkdir -p "$work/own"
cp tests/golden/curls_still.png "$work/own/a.png"
cp tests/golden/curls_still.png "$work/own/b.png"
run 2 "$work/own/a.png" "$work/own/b.png" --json "$work/own/a.png"; one_line; says "--json"
run 2 "$work/own/a.png" "$work/own/b.png" --json "$work/x" --junit "$work/x"; one_line; says "--junit"
run 2 "$work/own" tests/golden --sheet "$work/own"; one_line; says "--sheet"
equal "$work/own/a.png" tests/golden/curls_still.png

claim "images in subfolders are paired by their relative names"
for d in nest_a nest_b; do mkdir -p "$work/$d/walk/fast" "$work/$d/.cache"; cp $a "$work/$d/front.png"; cp $a "$work/$d/walk/1.png"; done
cp $b "$work/nest_b/walk/1.png"; cp $a "$work/nest_a/walk/fast/2.png"; cp $a "$work/nest_b/walk/3.png"; cp $a "$work/nest_b/.cache/x.png"
run 1 "$work/nest_a" "$work/nest_b/" --sheet "$work/nest_sheets"
says "walk/1.png: different"; says "walk/fast/2.png: missing"; says "walk/3.png: new"; says "4 images: 1 same, 1 different, 1 new, 1 missing"; is_png "$work/nest_sheets/walk/1.png"
run 1 "$work/nest_a" "$work/nest_b" --only walk/%d.png; says "2 images: 1 different, 1 new"
mkdir -p "$work/nest_masks/walk"; cp $a "$work/nest_masks/walk/1.png"
run 1 "$work/nest_a" "$work/nest_b" --mask "$work/nest_masks"; says "pixels ignored"
mv "$work/nest_masks/walk/1.png" "$work/nest_masks/1.png"; run 3 "$work/nest_a" "$work/nest_b" --mask "$work/nest_masks"; says "the mask 1.png belongs to no image"
run 1 "$work/nest_a" "$work/nest_b" --update; equal "$work/nest_a/walk/3.png" $a; equal "$work/nest_a/walk/1.png" $b
ln -s .. "$work/nest_a/walk/loop"; run 3 "$work/nest_a" "$work/nest_b"; one_line; says "folders in each other"

claim "--platform leaves the folders of platforms and classes to their levels"
mkdir -p "$work/levels/cpu" "$work/levels/nvidia-h100-550" "$work/levels/walk"; cp $a "$work/levels/cpu/x.png"; cp $a "$work/levels/nvidia-h100-550/x.png"; cp $a "$work/levels/walk/1.png"
mkdir -p "$work/levels_new/walk"; cp $a "$work/levels_new/x.png"
run 1 "$work/levels" "$work/levels_new" --platform llvmpipe-x; says "x.png: same"; says "walk/1.png: missing"; says "2 images: 1 same, 1 missing"

finish
