#!/bin/sh
# SPDX-License-Identifier: MIT
# action.yml and examples/ci/ without their servers: the files' structure, and their very shell steps in copies of the
# project, with the environment that GitHub and GitLab set. Programs are not built again: `make` and `git` are stand-ins.
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

# A checkout of Tractrix as a server has it, and one of a project that uses it.
mkdir "$work/action" "$work/repo" "$work/stubs" "$work/steps" "$work/runner"
cp -r action.yml Makefile scripts src glsl assets "$work/action"
cp -r assets examples "$work/repo"
cat >"$work/stubs/make" <<END
#!/bin/sh
echo "make \$*" >>"$work/calls"
while [ "\$1" != -C ]; do shift; done
mkdir -p "\$2/out/release" && ln -sf "$programs"/tractrix-* "\$2/out/release/"
END
cat >"$work/stubs/git" <<END
#!/bin/sh
echo "git \$*" >>"$work/calls"
for last; do :; done
[ "\$1" != clone ] || cp -r "$work/action" "\$last"
END
printf '#!/bin/sh\necho "apt-get $*" >>"%s/calls"\n' "$work" >"$work/stubs/apt-get"
chmod +x "$work/stubs/"*
PATH=$work/stubs:$PATH
# Small images: one that passes, and one whose golden is of other hair.
fur='assets/fur.tfx --algo none --followers 0 --look plain --size 48x36 --frames 1'
printf 'good %s\n' "$fur" >"$work/repo/one.txt"
printf 'good %s\nwrong %s --color #ff0000\nlost nowhere.tfx\n' "$fur" "$fur" >"$work/repo/three.txt"
holds env TRACTRIX_BIN="$programs" scripts/compare-goldens "$work/repo/one.txt" "$work/repo/references" "$work/images" --update
cp "$work/repo/references/good.png" "$work/repo/references/wrong.png"

# github INPUT=VALUE...: takes the steps out of the action.
github() { holds "$steps" github "$work/action/action.yml" "$work/steps" "$@"; }
# step STATUS NAME: runs a step as the runner does.
step() {
    expected=$1
    : >"$work/runner/output"; : >"$work/runner/summary.md"
    (
        cd "$work/repo" || exit
        export CI=true GITHUB_ACTIONS=true GITHUB_WORKSPACE="$work/repo" GITHUB_ACTION_PATH="$work/action" \
            GITHUB_OUTPUT="$work/runner/output" GITHUB_STEP_SUMMARY="$work/runner/summary.md"
        exec bash --noprofile --norc -e -o pipefail "$work/steps/$2.sh"
    ) >"$work/out" 2>"$work/err" </dev/null
    status=$?
    if [ "$status" = "$expected" ]; then good; else bad "step $2: exit status $status, expected $expected"; fi
}
output() { in_file "$work/runner/output" "$1"; }

claim "the action names a build by system and sources"
github list=examples/ci/scenes.txt goldens=examples/ci/goldens out=images "options=$limits --mask examples/ci/masks"
for name in key install-packages build compare "uses actions/cache@v" "uses actions/upload-artifact@v"; do says "$name"; done
step 0 key; output key=tractrix-; key=$(cat "$work/runner/output")
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
step 0 compare; says "5 images: 5 same"; says "2720 pixels ignored"
output result=passed; output images=5; output failed=0; output report=images/report.json; in_file "$work/runner/summary.md" "### Images: 0 of 5 failed"
if grep -q '^::error' "$work/out"; then bad "an annotation without a failure"; else good; fi

claim "the action fails with annotations, outputs and a summary where images differ"
github list=three.txt goldens=references/ out=out/images
step 1 compare; says "good.png: same"
says "::error file=references/wrong.png,title=wrong.png%3A different::RMSE "
says "::error file=references/lost.png,title=lost.png%3A unrendered::nowhere.tfx: No such file or directory"
output result=failed; output images=3; output failed=2; output report=out/images/report.json
in_file "$work/runner/summary.md" "### Images: 2 of 3 failed"; in_file "$work/runner/summary.md" "\`out/images/sheets/wrong.png\`"
in_file "$work/repo/out/images/report.xml" "[[ATTACHMENT|out/images/sheets/wrong.png]]"; is_png "$work/repo/out/images/sheets/wrong.png"
github list=three.txt goldens=nothing out=out/none
step 3 compare; says "no goldens yet"; output result=failed
if grep -qE '^(images|failed)=' "$work/runner/output"; then bad "counts without a report"; else good; fi
github list=one.txt "goldens=new images" "out=out/of this" options=--update
step 0 compare; is_png "$work/repo/new images/good.png"

claim "an action or workflow with a mistake is noticed"
holds "$steps" workflow examples/ci/github-workflow.yml action.yml; says "list=examples/ci/scenes.txt"
sed 's/inputs.goldens/inputs.golden/' action.yml >"$work/bad.yml"
if "$steps" github "$work/bad.yml" "$work/steps" list=a goldens=b 2>/dev/null >&2; then bad "an input that is not there passes"; else good; fi
sed 's/          goldens: .*/          golden: x/' examples/ci/github-workflow.yml >"$work/bad.yml"
if "$steps" workflow "$work/bad.yml" action.yml 2>/dev/null >&2; then bad "a workflow with a wrong input passes"; else good; fi

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
finish
