#!/bin/sh
# SPDX-License-Identifier: MIT
# The page of tractrix-bench --html and of its command `page`: first the content of the file, then the actions of a
# reader, in a headless Chromium.
. tests/support/claims.sh
. tests/support/browser.sh
program=$bin/tractrix-bench

claim "a command writes its rows as a page"
run 0 accuracy --part motions --algo chain --rates 60,120 --csv "$work/rows.csv" --json "$work/rows.json" --html "$work/rows.html"
is_file "$work/rows.html"
in_file "$work/rows.html" '"title":"tractrix-bench accuracy"'
in_file "$work/rows.html" '"command":"tractrix-bench accuracy --part motions --algo chain --rates 60,120'
in_file "$work/rows.html" '{"name":"rate_hz","number":true,"shown":true}'
in_file "$work/rows.html" "default-src 'none'"
if grep -q 'https\{0,1\}://\|unsafe' "$work/rows.html"; then bad "names something elsewhere"; else good; fi

claim "page shows CSV files, of several machines in one table"
cat >"$work/one.csv" <<END
part,algo,variant,settings,set,rate_hz,what,value,ms_min,verdict,front,command,renderer,cpu,commit
work,chain,,,1k16,60,error,0.02,10,holds,front,make it,one,A,1e52405
work,chain,,,1k16,120,error,0.01,20,holds,front,make it,one,A,1e52405
work,rope,</script><b>,,1k16,60,error,0.2,55,broken,,make it,one,A,1e52405
work,rope,</script><b>,,1k16,120,error,,30,,,make it,one,A,1e52405
END
sed 's/,one,A,/,two,B,/; s/1k16/10k32/' "$work/one.csv" >"$work/two.csv"
run 0 page "$work/one.csv" "$work/two.csv" --html "$work/page.html"; is_file "$work/page.html"; silent out
in_file "$work/page.html" 'u003c/script>'
if grep -q '</script><b>' "$work/page.html"; then bad "a text ends the data"; else good; fi

claim "wrong usage and input are named"
run 2 page "$work/one.csv"; says "expected FILE.csv... and --html"; one_line
run 2 page --html "$work/none.html"; one_line
run 2 page "$work/one.csv" --html "$work/none.html" --csv "$work/none.csv"; one_line
run 3 page "$work/none.csv" --html "$work/none.html"; says none.csv; one_line
printf 'a,b\n1\n' >"$work/cut.csv"
run 3 page "$work/cut.csv" --html "$work/none.html"; says "1 fields: expected 2, as in the header"; none "$work/none.html"
run 1 page "$work/one.csv" --html /proc/none/x.html; one_line
run 2 shaders --html "$work/none.html"; says "writes no rows"; none "$work/none.html"

claim "in a browser"
if [ -z "$browser" ]; then skip "no chromium here" && finish; fi
drive "$work/page.html" tests/bench/html_bench.js
claim "with a command's own rows"
cat >"$work/own.js" <<'END'
claim("its view is the one of its part", state.view.name === "Error by rate" && document.querySelectorAll("#plots svg").length > 5);
claim("every row is in the table", document.querySelectorAll("tbody tr").length === chosenRows().length);
finish();
END
drive "$work/rows.html" "$work/own.js"
finish
