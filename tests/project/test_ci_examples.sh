#!/bin/sh
# SPDX-License-Identifier: MIT
# action.yml and examples/ci/ without their servers: checks the files' structure, and runs their shell steps in copies
# of the project with the environment that GitHub and GitLab set. Programs are not built again: `make` and `git` are
# stubs.
# shellcheck disable=SC2016 # text of scripts
. tests/support/claims.sh
programs=$(realpath "$bin")
unset TRACTRIX_BIN CI_PROJECT_DIR GITHUB_WORKSPACE GITHUB_STEP_SUMMARY JENKINS_URL
steps=tests/support/ci_steps
limits="--pixel-tolerance 8 --max-failing-pixels 2%"

claim "the example's images are those of its goldens"
if ! python3 -c 'import yaml' 2>/dev/null; then
    # shellcheck disable=SC2086
    holds env TRACTRIX_BIN="$programs" scripts/compare-goldens examples/ci/scenes.txt examples/ci/goldens "$work/images" $limits --mask examples/ci/masks
    skip "no python3-yaml: the steps of action.yml and examples/ci/*.yml are not tried"
    finish
fi
if [ "$(cat examples/ci/goldens/*.png | wc -c)" -lt 100000 ]; then good; else bad "goldens of 100 kB or more"; fi

# A checkout of Tractrix as on a server, and a checkout of a project that uses it.
mkdir "$work/action" "$work/repo" "$work/stubs" "$work/steps" "$work/runner"
cp -r action.yml Makefile scripts src glsl assets "$work/action"
cp -r assets examples "$work/repo"
cat >"$work/stubs/make" <<END
#!/bin/sh
echo "make \$*" >>"$work/calls"
folder=.
while [ \$# -gt 0 ]; do [ "\$1" != -C ] || folder=\$2; shift; done
mkdir -p "\$folder/out/release" && ln -sf "$programs"/tractrix-* "\$folder/out/release/"
END
cat >"$work/stubs/git" <<END
#!/bin/sh
echo "git \$*" >>"$work/calls"
for last; do :; done
[ "\$1" != clone ] || cp -r "$work/action" "\$last"
END
printf '#!/bin/sh\necho "apt-get $*" >>"%s/calls"\n' "$work" >"$work/stubs/apt-get"
# A stub of gh. Releases are in $work/releases/WHO/NAME/TAG, attestations are lines "FILE WHO/NAME REF" of
# $work/attested, the server's answers are in $work/server, by the path of the call; sent data goes to $work/sent.
cat >"$work/stubs/gh" <<END
#!/bin/bash
echo "gh \$*" >>"$work/calls"
case "\$1 \$2" in
"release download")
    tag=\$3; shift 3
    while [ \$# -gt 0 ]; do
        case \$1 in --repo) from=$work/releases/\$2/\$tag ;; --dir) to=\$2 ;; --pattern) cp "\$from/"\$2 "\$to/" || exit 1 ;; esac
        shift 2
    done ;;
"attestation verify")
    grep -qxF "\$(basename "\$3") \$5 \$7" "$work/attested" ;;
api\ *)
    shift; method=GET input= filter=.
    while [ \$# -gt 0 ]; do
        case \$1 in --paginate) ;; --method) method=\$2; shift ;; --input) input=\$2; shift ;; --jq) filter=\$2; shift ;; *) path=\$1 ;; esac
        shift
    done
    if [ "\$method" != GET ]; then echo "\$method \$path" >"$work/sent.call"; cp "\$input" "$work/sent"; exit; fi
    jq -r "\$filter" "$work/server/\$(basename "\${path%%\\?*}").json" ;;
esac
END
# A stub of curl: GET returns $work/server/notes.json, but only with a token.
cat >"$work/stubs/curl" <<END
#!/bin/bash
grep -q 'PRIVATE-TOKEN: secret' || exit 22
method=GET
while [ \$# -gt 0 ]; do
    case \$1 in --config) shift ;; --request) method=\$2; shift ;; --data-urlencode) cp "\${2#body@}" "$work/sent"; shift ;; --dump-header) printf 'x-next-page: \r\n' >"\$2"; shift ;; http*) url=\$1 ;; esac
    shift
done
if [ \$method = GET ]; then cat "$work/server/notes.json"; else echo "\$method \$url" >"$work/sent.call"; fi
END
chmod +x "$work/stubs/"*
mkdir "$work/server"
real=$(command -v git)
PATH=$work/stubs:$PATH
# Small images: one that passes, and one whose golden shows other hair.
fur='assets/fur.tfx --algo none --followers 0 --look plain --size 48x36 --frames 1'
printf 'good %s\n' "$fur" >"$work/repo/one.txt"
printf 'good %s\nwrong %s --color #ff0000\nlost nowhere.tfx\n' "$fur" "$fur" >"$work/repo/three.txt"
holds env TRACTRIX_BIN="$programs" scripts/compare-goldens "$work/repo/one.txt" "$work/repo/references" "$work/images" --update
cp "$work/repo/references/good.png" "$work/repo/references/wrong.png"

# github INPUT=VALUE...: extracts the steps of the action.
github() { holds "$steps" github "$work/action/action.yml" "$work/steps" "$@"; }
# step STATUS NAME: runs a step as the runner does.
step() {
    expected=$1
    : >"$work/runner/output"; : >"$work/runner/summary.md"
    (
        cd "$work/repo" || exit
        export CI=true GITHUB_ACTIONS=true GITHUB_WORKSPACE="$work/repo" GITHUB_ACTION_PATH="$work/action" \
            GITHUB_OUTPUT="$work/runner/output" GITHUB_STEP_SUMMARY="$work/runner/summary.md" RUNNER_TEMP="$work/runner"
        exec bash --noprofile --norc -e -o pipefail "$work/steps/$2.sh"
    ) >"$work/out" 2>"$work/err" </dev/null
    status=$?
    if [ "$status" = "$expected" ]; then good; else bad "step $2: exit status $status, expected $expected"; fi
}
output() { in_file "$work/runner/output" "$1"; }

claim "the action takes the release of its own tag, if it is verified"
github list=three.txt goldens=references
step 0 release; says "Built from source: the action is a folder of the checkout"
machine=$(uname -m) version=9.9.8 tag=v9.9.8
archive=tractrix-$version-linux-$machine.tar.gz release=$work/releases/who/hair/$tag
mkdir -p "$release" "$work/packed/${archive%.tar.gz}/bin"
cp "$programs/tractrix-render" "$work/packed/${archive%.tar.gz}/bin/"
cat >"$work/packed/${archive%.tar.gz}/bin/tractrix-compare" <<END
#!/bin/sh
if [ "\$1" = --version ]; then echo "tractrix-compare $version"; else exec "$programs/tractrix-compare" "\$@"; fi
END
chmod +x "$work/packed/${archive%.tar.gz}/bin/tractrix-compare"
tar -czf "$release/$archive" -C "$work/packed" "${archive%.tar.gz}"
(cd "$release" && sha256sum "$archive" >SHA256SUMS)
: >"$work/attested"
export ACTION_REPOSITORY=who/hair ACTION_REF=$tag
refused() { step 0 release; says "::notice title=Tractrix::Built from source: "; says "$1"; if grep -q '^bin=' "$work/runner/output"; then bad "took it"; else good; fi; }
refused "no attestation says that who/hair has made $archive at $tag"
echo "$archive who/hair refs/tags/$tag" >"$work/attested"
step 0 release; says "Tractrix $version of who/hair, verified"; output "bin=$work/runner/tractrix-release/bin"
BIN=$work/runner/tractrix-release/bin; export BIN
: >"$work/calls"
step 0 install-packages; step 1 compare; says "good.png: same"; unset BIN
ACTION_REF=main; refused "'main' is no tag of a release"
ACTION_REF=v9.9.9; refused "who/hair has no tractrix-9.9.9-linux-$machine.tar.gz with SHA256SUMS at v9.9.9"
ACTION_REF=$tag
echo >>"$release/$archive"; refused "$archive is not the file of SHA256SUMS"
(cd "$release" && sed "s/  .*/  other/" SHA256SUMS >x && mv x SHA256SUMS); refused "is not the file of SHA256SUMS"
(cd "$release" && tar -czf "$archive" -C "$programs/.." --transform "s,^,x/bin/," "$(basename "$programs")/tractrix-gen" && sha256sum "$archive" >SHA256SUMS)
refused "$archive does not run here, or is another version"
ACTION_REPOSITORY=who/else; refused "who/else has no"
# If GitHub leaves both empty, they are taken from the action's path.
ACTION_REPOSITORY='' ACTION_REF=''
mkdir -p "$work/_actions/who/hair"; cp -r "$work/action" "$work/_actions/who/hair/v9.9.9"
holds env GITHUB_OUTPUT="$work/runner/output" RUNNER_TEMP="$work/runner" "$work/_actions/who/hair/v9.9.9/scripts/action" release; says "who/hair has no tractrix-9.9.9"
unset ACTION_REPOSITORY ACTION_REF
github list=three.txt goldens=references prebuilt=false
refused "prebuilt is false"

claim "the action names a build by system and sources"
github list=examples/ci/scenes.txt goldens=examples/ci/goldens out=images "options=$limits --mask examples/ci/masks"
for name in key install-packages build compare "uses actions/cache@v" "uses actions/upload-artifact@v"; do says "$name"; done
step 0 key; output key=tractrix-; output "programs=$work/action/out/release/tractrix-*"; key=$(cat "$work/runner/output")
step 0 key; if [ "$(cat "$work/runner/output")" = "$key" ]; then good; else bad "another key for the same sources"; fi
echo >>"$work/action/glsl/sim/forces.glsl"
step 0 key; if [ "$(cat "$work/runner/output")" != "$key" ]; then good; else bad "one key for two sources"; fi

claim "the steps are clean shell"
if command -v shellcheck >/dev/null; then
    holds shellcheck -s bash -e SC1091,SC2086,SC2164 "$work"/steps/*.sh # system files, options as words; bash -e
else
    skip "no shellcheck"
fi

claim "the action installs, builds, and passes the example"
step 0 install-packages
step 0 build; in_file "$work/calls" "make --silent -C $work/action -j "
step 0 compare; says "5 images: "; says "2720 pixels ignored"
output result=passed; output images=5; output failed=0; output report=images/report.json; in_file "$work/runner/summary.md" "### Images: 0 of 5 failed"
if grep -q '^::error' "$work/out"; then bad "an annotation without a failure"; else good; fi

claim "the action fails with annotations, outputs and a summary where images differ"
github list=three.txt goldens=references/ out=out/images
step 1 compare; says "good.png: same"
says "::error file=references/wrong.png,title=wrong.png%3A different::RMSE "
says "::error file=references/lost.png,title=lost.png%3A unrendered::nowhere.tfx: No such file or directory"
output result=failed; output images=3; output failed=2; output report=out/images/report.json
says "to accept the new images: tractrix-compare references/ out/images/frames/"
in_file "$work/runner/summary.md" "### Images: 2 of 3 failed"; in_file "$work/runner/summary.md" "\`out/images/sheets/wrong.png\`"
in_file "$work/repo/out/images/report.xml" "[[ATTACHMENT|out/images/sheets/wrong.png]]"; is_png "$work/repo/out/images/sheets/wrong.png"
github list=three.txt goldens=nothing out=out/none
step 3 compare; says "no goldens yet"; output result=failed
if grep -qE '^(images|failed)=' "$work/runner/output"; then bad "counts without a report"; else good; fi
github list=one.txt "goldens=new images" "out=out/of this" options=--update
step 0 compare; is_png "$work/repo/new images/good.png"

claim "the summary leads to the artifact"
(export URL=https://example.invalid/artifact; step 0 link-the-report); in_file "$work/runner/summary.md" "(https://example.invalid/artifact)"

claim "an action or workflow with a mistake is noticed"
holds "$steps" workflow examples/ci/github-workflow.yml action.yml "$work/steps"; says "list=examples/ci/scenes.txt"
sed 's/inputs.goldens/inputs.golden/' action.yml >"$work/bad.yml"
if "$steps" github "$work/bad.yml" "$work/steps" list=a goldens=b 2>/dev/null >&2; then bad "an input that is not there passes"; else good; fi
sed 's/          goldens: .*/          golden: x/' examples/ci/github-workflow.yml >"$work/bad.yml"
if "$steps" workflow "$work/bad.yml" action.yml 2>/dev/null >&2; then bad "a workflow with a wrong input passes"; else good; fi

claim "the workflow says what to do"
(export FAILED=2 IMAGES=3; step 0 say-what-to-do; says "2 of 3 images failed"; echo "$failed" >"$work/failed"); if [ "$(cat "$work/failed")" = "$failed" ]; then good; else bad "see above"; fi

# comment STATUS: runs the step of github-comment.yml on the images that the previous step has left.
comment() {
    rm -f "$work/sent" "$work/sent.call"
    expected=$1
    (cd "$work/pull" && exec env GITHUB_REPOSITORY=me/grooms GH_TOKEN=x HEAD_SHA="$sha" REPORT_URL=https://github.com/me/grooms/actions/runs/1 \
        IMAGES_REMOTE="$work/pictures.git" RUNNER_TEMP="$work/pull" bash --noprofile --norc -e -o pipefail "$work/steps/say-what-needs-a-look.sh") >"$work/out" 2>"$work/err" </dev/null
    status=$?
    if [ "$status" = "$expected" ]; then good; else bad "exit status $status, expected $expected"; fi
}
sha=0123456789abcdef0123456789abcdef01234567
mkdir "$work/pull"
ln -s "$PWD/scripts" "$work/pull/scripts"
cp -r "$work/repo/out/images" "$work/pull/images"
echo "[{\"number\": 7, \"head\": {\"sha\": \"$sha\"}}, {\"number\": 8, \"head\": {\"sha\": \"x\"}}]" >"$work/server/pulls.json"
echo '[{"id": 1, "user": {"login": "somebody"}, "body": "<!-- tractrix tractrix -->"}, {"id": 2, "user": {"login": "github-actions[bot]"}, "body": "other"}]' >"$work/server/comments.json"

claim "a pull request gets one comment, in which images that need a look stand in a table"
holds "$steps" comment examples/ci/github-comment.yml "$work/steps"; says say-what-needs-a-look
if command -v jq >/dev/null && command -v git >/dev/null; then
comment 0; says "pull request 7: 2 images need a look"
in_file "$work/sent.call" "POST repos/me/grooms/issues/7/comments"
jq -r .body "$work/sent" >"$work/body"
if [ "$(head -n 1 "$work/body")" = "<!-- tractrix tractrix -->" ]; then good; else bad "$(head -n 1 "$work/body")"; fi
in_file "$work/body" "### Images: 2 of 3 need a look"; in_file "$work/body" '| `wrong.png` | different (common) | 0.'; in_file "$work/body" '| `lost.png` | unrendered |  |  |'
in_file "$work/body" "(https://github.com/me/grooms/actions/runs/1)"
if grep -q '!\[' "$work/body"; then bad "a picture without a branch for it"; else good; fi

claim "the comment of the run before is edited, also when all is well again; none is made while all is well"
printf '%s\n' '[{"id": 2, "user": {"login": "github-actions[bot]"}, "body": "<!-- tractrix tractrix -->\nold"}]' >"$work/server/comments.json"
comment 0; in_file "$work/sent.call" "PATCH repos/me/grooms/issues/comments/2"
cp "$work/pull/images/report.json" "$work/report.json"
jq '.pairs |= map(.good = true | .outcome = "same")' "$work/report.json" >"$work/pull/images/report.json"
comment 0; in_file "$work/sent" "Images: 0 of 3 need a look"
echo '[]' >"$work/server/comments.json"
comment 0; says "all images are equal: no comment"; none "$work/sent"
cp "$work/report.json" "$work/pull/images/report.json"

claim "with a branch the comment has pictures, which are made anew and go after 30 days"
mv "$work/stubs/git" "$work/git"
"$real" init --quiet --bare "$work/pictures.git"
IMAGES_BRANCH=pictures; export IMAGES_BRANCH
comment 1; one_line; says "no out/release/tractrix-compare, which makes pictures"; none "$work/sent"
if (cd "$work/pull" && bash --noprofile --norc -e -o pipefail "$work/steps/build-the-program-that-makes-pictures.sh" >/dev/null); then good; else bad "no program"; fi
in_file "$work/calls" " out/release/tractrix-compare"
comment 0; jq -r .body "$work/sent" >"$work/body"
at=$(date -u +%Y-%m-%d)/$sha
in_file "$work/body" "![wrong.png](https://raw.githubusercontent.com/me/grooms/refs/heads/pictures/$at/wrong.png.jpg)"
"$real" -C "$work/pictures.git" show "pictures:$at/wrong.png.jpg" >"$work/picture.jpg"
if [ "$(head -c 3 "$work/picture.jpg" | od -An -tx1 | tr -d ' ')" = ffd8ff ]; then good; else bad "no JPEG file"; fi
old=$work/old; "$real" clone --quiet "$work/pictures.git" -b pictures "$old"; mkdir "$old/2020-01-01"; touch "$old/2020-01-01/x"
"$real" -C "$old" add -A
tip=$("$real" -C "$old" -c user.name=tractrix -c user.email=tractrix@localhost commit-tree "$("$real" -C "$old" write-tree)" -m "Images of x")
"$real" -C "$old" push --quiet --force origin "$tip:pictures"
# Another run pushes between this run's query and its push: it tries again.
printf '#!/bin/sh\n[ ! -e once ] || { rm once; exit 1; }\n' >"$work/pictures.git/hooks/pre-receive"; chmod +x "$work/pictures.git/hooks/pre-receive"
touch "$work/pictures.git/once"
comment 0; none "$work/pictures.git/once"
if [ "$("$real" -C "$work/pictures.git" ls-tree -r --name-only pictures)" = "$at/wrong.png.jpg" ]; then good; else bad "$("$real" -C "$work/pictures.git" ls-tree -r --name-only pictures)"; fi
if [ "$("$real" -C "$work/pictures.git" rev-list --count pictures)" = 1 ]; then good; else bad "the branch grows"; fi

claim "a branch with commits of others is refused and stays, and so is one that cannot be read"
"$real" -C "$old" -c user.name=x -c user.email=x commit --quiet --allow-empty -m "Images of the work of weeks" && "$real" -C "$old" push --quiet origin HEAD:main
before=$("$real" -C "$work/pictures.git" rev-parse main)
IMAGES_BRANCH=main; comment 1; one_line; says "main has commits of others"; none "$work/sent"
if [ "$("$real" -C "$work/pictures.git" rev-parse main)" = "$before" ]; then good; else bad "it was pushed over"; fi
"$real" -C "$old" -c user.name=tractrix -c user.email=tractrix@localhost commit --quiet --allow-empty -m "Images of a merge" && "$real" -C "$old" push --quiet origin HEAD:main
comment 1; one_line; says "main has commits of others"
mv "$work/pictures.git" "$work/away.git"
comment 1; says "main: cannot ask whether this branch exists"; none "$work/sent"
mv "$work/away.git" "$work/pictures.git"
unset IMAGES_BRANCH

claim "what a stranger's run has left is taken for text, never for more"
jq '.pairs[1].name = "a|b`](http://x) @all" | .pairs[2].name = "../../etc/passwd" | .pairs += [{"name": "ok.png", "outcome": "<img>", "good": false}, "x", {"name": "fine.png", "outcome": "new", "good": false, "flip": "| x", "level": "@x"}]' "$work/report.json" >"$work/pull/images/report.json"
ln -sf /etc/passwd "$work/pull/images/sheets/fine.png"
IMAGES_BRANCH=pictures; export IMAGES_BRANCH; comment 0; unset IMAGES_BRANCH; jq -r .body "$work/sent" >"$work/body"
for bad_text in http://x @all passwd '<img>' '| x' @x '!['; do
    if grep -qF -- "$bad_text" "$work/body"; then bad "the comment has $bad_text"; else good; fi
done
in_file "$work/body" '| `fine.png` | new |  |  |'
for sha in "" x "0123456789abcdef0123456789abcdef0123456\""; do comment 1; one_line; says "HEAD_SHA: got"; none "$work/sent"; done
sha=0123456789abcdef0123456789abcdef01234567
echo '[' >"$work/pull/images/report.json"; comment 1; says "not a report"; none "$work/sent"
rm "$work/pull/images/report.json"; comment 1; one_line; says "no such file"; none "$work/sent"
head -c 4000001 /dev/zero >"$work/pull/images/report.json"; comment 1; one_line; says "more than 4 MB"
jq '[range(3000) as $i | {name: "n\($i).png", outcome: "new", good: false}] | {images: 3000, pairs: .}' -n >"$work/pull/images/report.json"
comment 0; in_file "$work/sent" "3000 of 3000 need a look"; in_file "$work/sent" "2900 more are in the report"
sha=ffffffffffffffffffffffffffffffffffffffff; comment 0; says "no open pull request has the commit"; none "$work/sent"
mv "$work/git" "$work/stubs/git"
else
    skip "no jq: comments are not tried"
fi

# gitlab STATUS VARIABLE=VALUE...: runs the job as GitLab's runner does.
gitlab() {
    expected=$1; shift
    (cd "$work/repo" && exec env CI=true GITLAB_CI=true CI_PROJECT_DIR="$work/repo" CI_SERVER_URL=https://gitlab.test CI_PROJECT_NAMESPACE=hair "$@" bash -e -o pipefail "$work/steps/job.sh") \
        >"$work/out" 2>"$work/err" </dev/null
    status=$?
    if [ "$status" = "$expected" ]; then good; else bad "exit status $status, expected $expected"; fi
}

claim "the project's own workflows are sound"
for file in .github/workflows/*.yml; do holds "$steps" jobs "$file"; done
sed 's/scripts\/release/scripts\/relaese/' .github/workflows/release.yml >"$work/bad.yml"
if "$steps" jobs "$work/bad.yml" 2>/dev/null >&2; then bad "a workflow that runs no script of ours passes"; else good; fi

claim "a release without an engine for its container fails if the container was asked for"
mkdir "$work/tools"
for tool in bash dirname realpath; do ln -s "$(command -v $tool)" "$work/tools/"; done
PATH=$work/tools "$work/tools/bash" scripts/release "$work/dist" archive container >"$work/out" 2>"$work/err"
if [ $? = 1 ]; then good; else bad "the container is left out"; fi
one_line; says "release: container: no buildah or podman here: expected one of them"; none "$work/dist"
in_file .github/workflows/release.yml "scripts/release dist archive wheel packages container"

claim "GitLab's job clones, builds and compares, and keeps what its report names"
holds "$steps" gitlab examples/ci/gitlab-ci.yml images "$work/steps/job.sh"; says "tractrix-images/report.xml"
if command -v shellcheck >/dev/null; then holds shellcheck -s sh -e SC2086 "$work/steps/job.sh"; fi
in_file "$work/steps/job.sh" 'TRACTRIX_GOLDENS=${TRACTRIX_GOLDENS-examples/ci/goldens}'
gitlab 0 TRACTRIX_DIR=.tractrix TRACTRIX_LIST=one.txt "TRACTRIX_GOLDENS=new images" "TRACTRIX_OPTIONS=$limits"; says "1 image: 1 same"
in_file "$work/calls" "git clone --quiet --depth 1 --branch v$(sed -n "s/^VERSION := //p" Makefile) https://gitlab.test/hair/tractrix.git .tractrix"
in_file "$work/calls" "make --silent -C .tractrix -j "; is_file "$work/repo/tractrix-images/report.xml"
gitlab 1 TRACTRIX_DIR=.tractrix TRACTRIX_LIST=three.txt TRACTRIX_GOLDENS=references "TRACTRIX_OPTIONS=$limits"; says "wrong.png: different"; says "lost.png: unrendered"
if [ "$(grep -c '^git clone' "$work/calls")" = 1 ]; then good; else bad "cloned again"; fi
in_file "$work/repo/tractrix-images/report.xml" 'failures="1" errors="1"'
in_file "$work/repo/tractrix-images/report.xml" "[[ATTACHMENT|tractrix-images/sheets/wrong.png]]"

claim "GitLab's merge request gets a note, which is edited"
command -v jq >/dev/null || { skip "no jq" && finish; }
# note: runs the job's after_script.
note() {
    rm -f "$work/sent" "$work/sent.call"
    (cd "$work/repo" && exec env CI_PROJECT_DIR="$work/repo" TRACTRIX_DIR=.tractrix CI_API_V4_URL=https://gitlab.example/api/v4 CI_PROJECT_ID=5 CI_JOB_URL=https://gitlab.example/me/p/-/jobs/9 "$@" \
        bash -e -o pipefail "$work/steps/job.sh.after") >"$work/out" 2>"$work/err" </dev/null
    status=$?
    if [ "$status" = 0 ]; then good; else bad "exit status $status"; fi
}
echo '[{"id": 3, "body": "x"}]' >"$work/server/notes.json"
note TRACTRIX_TOKEN=secret CI_MERGE_REQUEST_IID=4; says "merge request 4: 2 images need a look"
in_file "$work/sent.call" "POST https://gitlab.example/api/v4/projects/5/merge_requests/4/notes"
in_file "$work/sent" "### Images: 2 of 3 need a look"; in_file "$work/sent" "[wrong.png](https://gitlab.example/me/p/-/jobs/9/artifacts/file/tractrix-images/sheets/wrong.png)"
in_file "$work/sent" "/artifacts/file/tractrix-images/report.html"
printf '%s\n' '[{"id": 3, "body": "x"}, {"id": 6, "body": "<!-- tractrix tractrix -->\nold"}]' >"$work/server/notes.json"
note TRACTRIX_TOKEN=secret CI_MERGE_REQUEST_IID=4; in_file "$work/sent.call" "PUT https://gitlab.example/api/v4/projects/5/merge_requests/4/notes/6"
note TRACTRIX_TOKEN= CI_MERGE_REQUEST_IID=4; says "no note: \$TRACTRIX_TOKEN is not set"; none "$work/sent"
note TRACTRIX_TOKEN=secret; says "no note: \$CI_MERGE_REQUEST_IID is not set"; none "$work/sent"
finish
