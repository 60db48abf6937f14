# SPDX-License-Identifier: MIT
# Converts report.json of tractrix-compare to Markdown, for comments: a heading, and a table of the images that need a
# look. The report may come from a stranger, so only plain names, known outcomes and numbers are taken from it.
# --arg sheets PREFIX: prefix of links to the sheets ("": no links); --argjson pictures NAMES: those that have a picture
# at PREFIX
def number: if type == "number" then (. * 10000 | round) / 10000 | tostring else "" end;
def known: . as $outcome | ["same", "within limits", "different", "size mismatch", "new", "missing", "unrendered", "unreadable", "failed"] | index($outcome) != null;
def level: if . == "platform" or . == "class" or . == "common" then " (\(.))" else "" end;
def plain: type == "string" and test("\\A[A-Za-z0-9._%-]{1,80}\\z");
def row: "| `\(.name)` | \(.outcome)\(if .outcome == "different" then .level | level else "" end)\(if .updated == true then ", updated" else "" end) | \(.flip | number) | \(.failing_pixels | number) |";
def picture: . as $name | "\n`\($name)`: golden, new, difference\n\n![\($name)](\($sheets)\($name | gsub("%"; "%25")).jpg)\n";

[.pairs[]? | select(type == "object") | select((.name | plain) and (.outcome | known))] as $pairs
| [$pairs[] | select(.good != true)] as $bad
| ([.pairs[]?] | length) as $listed
| (if (.images | type) == "number" then .images else $listed end) as $images
| ([.pairs[]? | select(type == "object" and .good != true)] | length) as $failed
| "### Images: \($failed) of \($images | number) need a look\n",
  (if ($bad | length) > 0 then
      "| image | result | FLIP | failing pixels |\n| --- | --- | ---: | ---: |\n" + ([limit(100; $bad[]) | row] | join("\n")) + "\n"
  else empty end),
  (if $failed > ([100, ($bad | length)] | min) then "\(100 as $most | $failed - ([$most, ($bad | length)] | min)) more are in the report.\n" else empty end),
  ([limit(20; $bad[]) | .name | select(. as $name | $pictures | index($name) != null) | picture] | join(""))
