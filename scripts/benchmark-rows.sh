# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2016,SC2154 # sourced; awk programs
# Reads rows of tractrix-bench with awk; columns are accessed by name. For benchmark-tables and benchmark-words. `rows`
# must be the folder of NAME.csv. Defines rows_of NAME PROGRAM.

export LC_ALL=C # a fixed order of equal figures

# c["algo"] is the number of this column. Commas in a scenario are semicolons in the CSV file.
awk_functions='
    function digits(x) { return x == "" ? "-" : sprintf(x < 0.001 ? "%.2g" : x < 0.1 ? "%.4f" : x < 100 ? "%.3g" : "%.0f", x) }
    function percent(x) { return sprintf(x < 0.00095 ? "%.1g %%" : x < 0.095 ? "%.2g %%" : "%.0f %%", 100 * x) }
    function rule(n,  line) { line = "| ---"; while (n--) line = line " | ---:"; print line " |" }
    function name() { return $c["algo"] ($c["variant"] == "" ? "" : " `" $c["variant"] "`") ($c["settings"] == "" ? "" : " `" $c["settings"] "`") }
    function join(before, word) { return before == "" ? word : before ", " word }
    function method(  words) { # "`dftl` (`mueller`, `--ftl-damping 0.9`)"
        words = $c["variant"] == "" ? "" : "`" $c["variant"] "`"
        if ($c["settings"] != "") words = join(words, "`" $c["settings"] "`")
        return "`" $c["algo"] "`" (words == "" ? "" : " (" words ")")
    }
    function listed(words,  at) { # "a, b and c"
        for (at = length(words); at > 0 && substr(words, at, 2) != ", "; --at) { }
        return at ? substr(words, 1, at - 1) " and " substr(words, at + 2) : words
    }
    function range(low, high) { low = sprintf("%.2g", low); high = sprintf("%.2g", high); return low == high ? low : low " to " high }
    function short(path) { path = base(path); sub(/\..*/, "", path); return path } # the name of a set from the name of its file
    function base(path) { sub(/.*\//, "", path); return path }
'

rows_of() {
    [ -e "$rows/$1.csv" ] || { echo "$0: no $rows/$1.csv: measure $1 first" >&2; exit 1; }
    awk -F, "$awk_functions"' FNR == 1 { for (i = 1; i <= NF; ++i) c[$i] = i; next } '"$2" "$rows/$1.csv"
}

# Prints "Measured on DAY at commit C: CPU, RENDERER", a sentence about the rows of FILE.csv.
measured() {
    day=$(date -u -r "$rows/$1.csv" +%Y-%m-%d)
    rows_of "$1" 'FNR == 2 {
        gsub(/;/, ",", $c["renderer"])
        threads = ("threads" in c) && $c["threads"] + 0 ? " with " $c["threads"] " threads" : ""
        printf "Measured on '"$day"' at commit %s: %s%s, %s, OpenGL %s.\n", $c["commit"], $c["cpu"], threads, $c["renderer"], $c["gl_version"] }'
}
