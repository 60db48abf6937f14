# SPDX-License-Identifier: MIT
# Tractrix: headless hair simulator and renderer. `make help` lists the targets.
#
#   CONFIG  release (default), debug, sanitize, coverage, threads, analyzer, fuzz
#   OUT     where everything goes, out/$(CONFIG)
#   WERROR  not empty: warnings are errors              ONLY    `make test`: only tests with this in their name
#   V       not empty: show whole commands
#   CC, CPPFLAGS, CFLAGS, LDFLAGS, LDLIBS, PREFIX, LIBDIR and DESTDIR as usual; the flags are added to the project's own.

VERSION := 0.2.0
CONFIG  ?= release
OUT     := out/$(CONFIG)
PREFIX  ?= /usr/local
LIBDIR  ?= $(PREFIX)/lib
OBJCOPY ?= objcopy
ifeq ($(origin CC),default)
CC := gcc
endif

ifeq ($(filter $(CONFIG),release debug sanitize coverage threads analyzer fuzz),)
$(error CONFIG=$(CONFIG): expected release, debug, sanitize, coverage, threads, analyzer or fuzz)
endif
ifeq ($(CONFIG),analyzer)
CC := gcc
endif
ifeq ($(CONFIG),fuzz)
CC := clang
endif

# --- Flags. Only the headers of stb are used; its pkg-config file would link a library that nothing here needs. Of
# OpenEXR only the C core is used, not its C++ libraries.
LIBRARIES := epoxy egl libdeflate libisal libpng jansson muparser
HEADERS   := cglm stb OpenEXR
MISSING   := $(shell for p in $(LIBRARIES) $(HEADERS); do pkg-config --exists $$p || echo $$p; done 2>/dev/null)

OPTIMISE_release  := -O2 -DNDEBUG
OPTIMISE_debug    := -O0 -g3 -DTRACTRIX_DEBUG
# -g1: reports name functions and lines; all of -g would double the time to compile src/lanes.
OPTIMISE_sanitize := -O1 -g1 -fno-omit-frame-pointer
SANITIZE_sanitize := -fsanitize=address,undefined -fno-sanitize-recover=undefined
OPTIMISE_coverage := -O1 -g
SANITIZE_coverage := --coverage -fprofile-update=atomic
OPTIMISE_threads  := -O1 -g -fno-omit-frame-pointer
SANITIZE_threads  := -fsanitize=thread
# Off because of false reports by gcc 12. malloc-leak: it loses track of memory that a structure behind a pointer has
# taken over (LeakSanitizer and `make torture` look for leaks). use-of-uninitialized-value: it does not follow loops
# that set an array element by element (clang-tidy does).
OPTIMISE_analyzer := -O1 -fanalyzer -DTRACTRIX_ANALYZER -Wno-analyzer-malloc-leak -Wno-analyzer-use-of-uninitialized-value
OPTIMISE_fuzz     := -O1 -g -fno-omit-frame-pointer
SANITIZE_fuzz     := -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined
LINKER_sanitize   := -Wl,--export-dynamic-symbol=dlclose
LINKER_threads    := $(LINKER_sanitize)

WARNINGS  := -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wvla $(if $(WERROR),-Werror)
# Warnings in the headers of other libraries cannot be fixed here; -isystem hides them.
INCLUDES  := $(patsubst -I%,-isystem %,$(shell pkg-config --cflags $(LIBRARIES) $(HEADERS) 2>/dev/null))
# -fPIC and hidden symbols: the same objects are used in programs and in the library, which exports only what tractrix.h
# declares. -ffp-contract=off: the same results whether or not the processor has fused multiply-adds.
C_FLAGS   := -std=c11 -D_GNU_SOURCE -I. -Isrc -Iglsl -I$(OUT) $(INCLUDES) $(WARNINGS) -ffp-contract=off -pthread -fPIC -fvisibility=hidden \
             $(OPTIMISE_$(CONFIG)) $(SANITIZE_$(CONFIG)) $(CPPFLAGS) $(CFLAGS)
LD_FLAGS  := -pthread -Wl,--as-needed $(SANITIZE_$(CONFIG)) $(LINKER_$(CONFIG)) $(LDFLAGS)
LD_LIBS   := $(shell pkg-config --libs $(LIBRARIES) 2>/dev/null) $(filter -L% -lOpenEXRCore%,$(shell pkg-config --libs OpenEXR 2>/dev/null)) -ldl -lm $(LDLIBS)

# --- Files, in the rooms of src/, glsl/ and tests/. Each src/<room>/main_<x>.c is the program tractrix-<x>; each
# tests/<room>/test_<x>.c is a program, too. The tests share tests/support/.
MAINS     := $(wildcard src/*/main_*.c)
STAND_IN  := src/mesh/write_stand_in.c # a tool of the build
SOURCES   := $(filter-out $(MAINS) $(STAND_IN),$(wildcard src/*/*.c src/*/*/*.c))
BENCH_SHADERS := $(wildcard glsl/bench/*)
SHADERS   := $(filter-out $(BENCH_SHADERS),$(wildcard glsl/*/*))
TESTS     := $(wildcard tests/*/test_*.c)
KEEP      := tests/support/keep_drivers.c
TEST_SHADERS := $(wildcard tests/glsl/*)
SUPPORT   := $(filter-out $(KEEP),$(wildcard tests/support/*.c))
FUZZ      := $(filter-out tests/fuzz/test_% tests/fuzz/engine.c,$(wildcard tests/fuzz/*.c))
PAGES     := $(filter %.html %.css %.js,$(wildcard src/report/*))
OBJECTS   := $(SOURCES:src/%.c=$(OUT)/%.o) $(if $(SHADERS),$(OUT)/glsl_sources.o) $(if $(BENCH_SHADERS),$(OUT)/bench/bench_glsl.o) \
             $(OUT)/report/report_texts.o $(OUT)/mesh/stand_in_table.o
PROGRAMS  := $(foreach main,$(MAINS),$(OUT)/$(patsubst main_%.c,tractrix-%,$(notdir $(main))))
TEST_PROGRAMS := $(TESTS:%.c=$(OUT)/%)
SUPPORT_OBJECTS := $(SUPPORT:%.c=$(OUT)/%.o) $(OUT)/tests/glsl_sources.o
FUZZ_OBJECTS := $(FUZZ:%.c=$(OUT)/%.o)
KEEP_sanitize := $(KEEP:%.c=$(OUT)/%.o)
KEEP_threads := $(KEEP_sanitize)
SCRIPTS   := $(addprefix $(OUT)/tractrix-,farm turntable compare-goldens) # programs that are scripts
MANUALS   := $(addsuffix .1,$(PROGRAMS) $(SCRIPTS)) $(OUT)/tractrix-gen-fur.1
SHELLS    := bash zsh fish
COMPLETIONS := $(foreach shell,$(SHELLS),$(addsuffix .$(shell),$(PROGRAMS) $(SCRIPTS)))
# Fault injection: the programs again, with each call of calls.def wrapped, and the code that makes these calls fail.
FAULTY    := $(PROGRAMS:$(OUT)/%=$(OUT)/faults/%)
FAULT_CALLS := $(shell sed -nEf tests/faults/wrapped.sed tests/faults/calls.def)
TORTURE   := $(OUT)/tests/faults/torture
DELAYS    := $(OUT)/tests/faults/delays.so
TORTURE_OBJECTS := $(patsubst %.c,$(OUT)/%.o,$(filter-out tests/faults/inject.c tests/faults/delays.c,$(wildcard tests/faults/*.c)))
FOLDERS   := $(sort $(OUT)/lib/ $(OUT)/lib/pkgconfig/ $(OUT)/lib/cmake/tractrix/ $(dir $(OBJECTS) $(SUPPORT_OBJECTS) $(FUZZ_OBJECTS) $(TEST_PROGRAMS) $(FAULTY) $(TORTURE)))

# --- Build. Recipes that call make use all processors unless -j says otherwise.
JOBS = $(if $(filter -j% --jobserver%,$(MAKEFLAGS)),,-j$(shell nproc))
AGAIN = @$(MAKE) --no-print-directory

# $(call run,WORD,COMMAND): prints a short line instead of the command unless V=1; prints nothing with make --silent.
SILENT := $(findstring s,$(firstword -$(MAKEFLAGS)))
run = $(if $(V),$(2),@$(if $(SILENT),,printf '  %-6s %s\n' $(1) $@; )$(2))

all: $(OUT)/libtractrix.a $(PROGRAMS) $(SCRIPTS) library ## build the programs and the library (default)
tests: $(TEST_PROGRAMS) $(FAULTY) $(TORTURE)
	@:
faults: $(PROGRAMS) $(FAULTY) $(TORTURE) # what tests/faults/test_faults.sh runs
	@:

$(OUT)/%.o: src/%.c $(OUT)/flags | $(OUT)/version.h
	$(call run,CC,$(CC) $(C_FLAGS) -MMD -MP -c -o $@ $<)
ifeq ($(CONFIG),release) # the reference for speed must be as fast as the compiler can make it
$(OUT)/bench/cpu_split.o: C_FLAGS += -O3 -fno-math-errno -fno-trapping-math -ffinite-math-only -fno-signed-zeros -ffp-contract=fast
endif
KEEP_LOOPS := $(shell $(CC) -Werror --param max-completely-peel-times=15 -x c -c /dev/null -o /dev/null 2>/dev/null && echo --param max-completely-peel-times=15)
LANE_PIXELS := $(addprefix $(OUT)/lanes/,composite.o pixels.o shade.o project.o)
LANE_FLAGS := $(if $(filter release,$(CONFIG)),-O3) -fno-math-errno -fno-trapping-math
# Lanes: without these flags, selects and square roots are not vectorised, because they might trap or set errno. Loops
# of 16 lanes must not be unrolled before they are vectorised (gcc unrolls loops of up to 16 turns). The results have
# the same bits.
$(filter-out $(LANE_PIXELS),$(patsubst src/%.c,$(OUT)/%.o,$(wildcard src/lanes/*.c))) $(OUT)/draw/fibre_lobes.o $(OUT)/draw/light_tables.o $(OUT)/draw/light_cone.o $(OUT)/mesh/mesh_binding.o $(OUT)/image/convolve.o $(OUT)/image/flip.o $(OUT)/image/ssim.o: C_FLAGS += $(LANE_FLAGS) $(KEEP_LOOPS)
$(OUT)/mesh/head.o: C_FLAGS += $(LANE_FLAGS) $(KEEP_LOOPS:15=6) # loops of 8 points
$(LANE_PIXELS): C_FLAGS += $(LANE_FLAGS) -ffinite-math-only -fno-signed-zeros
EMBED_GLSL := scripts/embed-text gpu/shader.h GlslSource
$(OUT)/glsl_sources.c: scripts/embed-text $(SHADERS) $(OUT)/files
	$(call run,EMBED,$(EMBED_GLSL) GLSL_SOURCES glsl/ $(SHADERS) >$@.tmp && mv $@.tmp $@)
$(OUT)/bench/bench_glsl.c: scripts/embed-text $(BENCH_SHADERS) $(OUT)/files # of the library, taken by the programs that name it
	$(call run,EMBED,$(EMBED_GLSL) BENCH_GLSL_SOURCES glsl/ $(BENCH_SHADERS) >$@.tmp && mv $@.tmp $@)
$(OUT)/tests/glsl_sources.c: scripts/embed-text $(TEST_SHADERS) $(OUT)/files
	$(call run,EMBED,$(EMBED_GLSL) TEST_GLSL_SOURCES glsl/ $(TEST_SHADERS) >$@.tmp && mv $@.tmp $@)
$(OUT)/report/report_texts.c: scripts/embed-text $(PAGES) $(OUT)/files
	$(call run,EMBED,scripts/embed-text report/report.h 'ReportText*' REPORT_TEXTS src/report/ $(PAGES) >$@.tmp && mv $@.tmp $@)
$(OUT)/glsl_sources.o $(OUT)/bench/bench_glsl.o $(OUT)/tests/glsl_sources.o $(OUT)/report/report_texts.o $(OUT)/mesh/stand_in_table.o: %.o: %.c $(OUT)/flags # C guarantees only 4095 characters in a string; all compilers accept more
	$(call run,CC,$(CC) $(C_FLAGS) -Wno-overlength-strings -MMD -MP -c -o $@ $<)
$(OUT)/mesh/stand_in_table.c: $(OUT)/mesh/write_stand_in
	$(call run,MAKE,$< >$@.tmp && mv $@.tmp $@)
$(OUT)/mesh/write_stand_in: $(addprefix $(OUT)/,mesh/write_stand_in.o $(addprefix mesh/,head.o simplify.o surface_net.o mesh.o) base/error.o base/simd.o base/quote.o base/utf8.o) $(KEEP_$(CONFIG))
	$(call run,LINK,$(CC) $(LD_FLAGS) -o $@ $^ -lm $(LDLIBS))
$(OUT)/image/jpeg.o: C_FLAGS += -fno-sanitize=shift # stb_image_write shifts bits beyond an int on purpose
$(OUT)/libtractrix.a: $(OBJECTS) $(OUT)/files
	$(call run,AR,rm -f $@ && $(AR) qcs $@ $(OBJECTS))
# The library for other programs (tractrix.h), made of its room and of what this needs from the archive above. The
# static library is a single object in which only the API has global names, so that no name can clash with the host's.
LIBRARY_OBJECTS := $(filter $(OUT)/library/%,$(OBJECTS))
CMAKE_FILES := cmake/tractrix/tractrix-config.cmake cmake/tractrix/tractrix-config-version.cmake
LIBRARY := $(addprefix $(OUT)/lib/,libtractrix.so.0 libtractrix.so libtractrix.a pkgconfig/tractrix.pc $(CMAKE_FILES))
SHARED  := -shared -Wl,-soname,libtractrix.so.0 -Wl,--version-script=src/library/tractrix.map -Wl,-z,nodelete
ifeq ($(SANITIZE_$(CONFIG)),)
SHARED  += -Wl,-z,defs
endif
library: $(LIBRARY) ## build libtractrix.so.0, libtractrix.a, tractrix.pc and files for CMake
$(OUT)/lib/libtractrix.so.0: $(LIBRARY_OBJECTS) $(OUT)/libtractrix.a src/library/tractrix.map
	$(call run,LINK,$(CC) $(LD_FLAGS) $(SHARED) -o $@ $(LIBRARY_OBJECTS) $(OUT)/libtractrix.a $(LD_LIBS))
$(OUT)/lib/libtractrix.so: $(OUT)/lib/libtractrix.so.0
	$(call run,LINK,ln -sf $(<F) $@)
$(OUT)/lib/tractrix.o: $(LIBRARY_OBJECTS) $(OUT)/libtractrix.a
	$(call run,LINK,$(LD) -r -o $@ $^ && $(OBJCOPY) --localize-hidden $@)
$(OUT)/lib/libtractrix.a: $(OUT)/lib/tractrix.o
	$(call run,AR,rm -f $@ && $(AR) qcs $@ $<)
$(OUT)/lib/pkgconfig/tractrix.pc: src/library/tractrix.pc.in $(OUT)/places
	$(call run,MAKE,sed -e 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(VERSION)|; s|@LIBRARIES@|$(LIBRARIES)|' \
	    -e 's|@LIBS@|$(filter -lOpenEXRCore%,$(LD_LIBS))|' $< >$@.tmp && mv $@.tmp $@)
$(OUT)/lib/cmake/tractrix/%.cmake: src/library/%.cmake.in $(OUT)/places
	$(call run,MAKE,sed -e 's|@INCLUDE@|$(shell realpath -m --relative-to=$(LIBDIR) $(PREFIX)/include)|; s|@VERSION@|$(VERSION)|' $< >$@.tmp && mv $@.tmp $@)
define program # MAIN: the program of src/MAIN.c, a room and its main
$(OUT)/$(patsubst main_%,tractrix-%,$(notdir $(1))): $(OUT)/$(1).o $(KEEP_$(CONFIG)) $(OUT)/libtractrix.a
	$$(call run,LINK,$$(CC) $$(LD_FLAGS) -o $$@ $$^ $$(LD_LIBS))
endef
$(foreach main,$(MAINS:src/%.c=%),$(eval $(call program,$(main))))
$(OUT)/tractrix-%.1: $(OUT)/tractrix-%
	$(call run,MAN,$< --help=man >$@.tmp && mv $@.tmp $@)
$(OUT)/tractrix-gen-fur.1: $(OUT)/tractrix-gen
	$(call run,MAN,$< fur --help=man >$@.tmp && mv $@.tmp $@)
define completion # SHELL
$(OUT)/tractrix-%.$(1): $(OUT)/tractrix-%
	$$(call run,SHELL,$$< --help=$(1) >$$@.tmp && mv $$@.tmp $$@)
$(SCRIPTS:%=%.$(1)): %.$(1): % scripts/help-pages
	$$(call run,SHELL,scripts/help-pages $(1) $$< $(VERSION) >$$@.tmp && mv $$@.tmp $$@)
endef
$(foreach shell,$(SHELLS),$(eval $(call completion,$(shell))))
# The scripts, with what they share inserted, so that each is one file.
$(SCRIPTS): $(OUT)/tractrix-%: scripts/% scripts/steps.sh | $(FOLDERS)
	$(call run,COPY,sed -e '/^STEPS_HOME=/d' -e '/^\. ".*\/steps\.sh"$$/{r scripts/steps.sh' -e 'd;}' $< >$@.tmp && chmod 755 $@.tmp && mv $@.tmp $@)
$(SCRIPTS:%=%.1): %.1: % scripts/help-pages $(OUT)/version.h
	$(call run,MAN,scripts/help-pages man $< "$$(sed -n 's/.*_VERSION "\(.*\)"/\1/p' $(OUT)/version.h)" >$@.tmp && mv $@.tmp $@)

$(OUT)/tests/%.o: tests/%.c $(OUT)/flags | $(OUT)/version.h
	$(call run,CC,$(CC) $(C_FLAGS) -Itests -MMD -MP -c -o $@ $<)
$(OUT)/tests/support/libsupport.a: $(SUPPORT_OBJECTS) $(OUT)/files
	$(call run,AR,rm -f $@ && $(AR) rcs $@ $(SUPPORT_OBJECTS))
$(OUT)/tests/fuzz/test_fuzz_corpora: $(FUZZ_OBJECTS)
$(OUT)/tests/fuzz/fuzz: $(OUT)/tests/fuzz/engine.o $(FUZZ_OBJECTS) $(OUT)/libtractrix.a
	$(call run,LINK,$(CC) $(LD_FLAGS) -fsanitize=fuzzer -o $@ $^ $(LD_LIBS))
$(OUT)/tests/%: $(OUT)/tests/%.o $(KEEP_$(CONFIG)) $(OUT)/tests/support/libsupport.a $(OUT)/libtractrix.a
	$(call run,LINK,$(CC) $(LD_FLAGS) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(LD_LIBS) -lcmocka)

define faulty # MAIN
$(OUT)/faults/$(patsubst main_%,tractrix-%,$(notdir $(1))): $(OUT)/$(1).o $(OUT)/tests/faults/inject.o $(KEEP_$(CONFIG)) $(OUT)/libtractrix.a
	$$(call run,LINK,$$(CC) $$(LD_FLAGS) $$(FAULT_CALLS:%=-Wl,--wrap=%) -o $$@ $$^ $$(LD_LIBS))
endef
$(foreach main,$(MAINS:src/%.c=%),$(eval $(call faulty,$(main))))
$(DELAYS): $(OUT)/tests/faults/delays.o
	$(call run,LINK,$(CC) -shared -o $@ $<)
$(TORTURE): $(TORTURE_OBJECTS) $(KEEP_$(CONFIG)) $(OUT)/libtractrix.a
	$(call run,LINK,$(CC) $(LD_FLAGS) -o $@ $^ $(LD_LIBS))

# Stamps are rewritten only if their content changes, so that files that depend on them are rebuilt only then: the
# flags, the list of files (one may have been removed), the installation paths, and the version.
quote = '$(subst ','\'',$(1))'
write_if_changed = printf '%s\n' $(call quote,$(1)) | cmp -s - $@ || printf '%s\n' $(call quote,$(1)) >$@
$(OUT)/flags: FORCE | $(FOLDERS)
	$(if $(MISSING),$(error missing: $(MISSING). Run scripts/setup, which installs what is needed on Debian and Ubuntu and lists it elsewhere))
	@$(call write_if_changed,$(CC) $(C_FLAGS) $(LD_FLAGS) $(LD_LIBS))
$(OUT)/files: FORCE | $(FOLDERS)
	@$(call write_if_changed,$(SOURCES) $(SHADERS) $(BENCH_SHADERS) $(PAGES) $(SUPPORT) $(TEST_SHADERS))
$(OUT)/places: FORCE | $(FOLDERS)
	@$(call write_if_changed,$(PREFIX) $(LIBDIR) $(VERSION) $(LIBRARIES) $(LD_LIBS))
$(OUT)/version.h: FORCE | $(FOLDERS)
	@scripts/write-version $(VERSION) $@
$(FOLDERS):
	@mkdir -p $@

# --- Targets for people. Set-up runs first and then starts make again, because the flags above call pkg-config.
demo: ## install missing packages, build, and render the bundled scene to out/demo/
	@scripts/setup build run
	$(AGAIN) $(JOBS) all
	@scripts/demo $(OUT) out/demo

# What the tests with ONLY in their name need: programs of tests by their name, and for scripts the programs of the project.
# Scripts that need more: test_NAME.sh, then what it needs.
ONLY_TESTS = $(filter $(shell basename -a tests/*/test_* tests/*/check_* | grep -E $(call quote,$(ONLY))),$(notdir $(wildcard tests/*/test_* tests/*/check_*)))
ONLY_NEEDS = $(foreach test,$(filter $(addprefix %/,$(filter %.c,$(ONLY_TESTS))),$(TESTS)),$(OUT)/$(test:%.c=%)) $(if $(filter-out %.c,$(ONLY_TESTS)),all) \
             $(if $(filter test_library_host.c,$(ONLY_TESTS)),library) $(if $(filter test_faults.sh,$(ONLY_TESTS)),faults) \
             $(if $(filter test_library_locale.sh,$(ONLY_TESTS)),$(addprefix $(OUT)/tests/library/test_library_,scene device))
test: ## install missing packages, build, and run all tests (ONLY=NAME: tests with NAME in their name, after building what they need)
	@scripts/setup build run test python
	$(AGAIN) $(JOBS) $(if $(ONLY),$(ONLY_NEEDS),all tests)
	@tests/runner $(OUT) $(ONLY)

# The thesis's sets: four that the program makes, Mohawk if its file lies beside the project, and hair of the same size
# as Short.
MOHAWK := ../shared/assets/ratboy_mohawk.tfx
SHORT   = $(OUT)/short_37747x8.tfx
bench: all ## measure solvers and renderer, print a table (BENCH="FILE... --size 1280x720": other hair, drawing, too)
	@$(if $(wildcard $(MOHAWK)),,echo "bench: no $(MOHAWK): without the thesis's Mohawk")
	@$(OUT)/tractrix-gen --kind fur --count 37747 --vertices 8 -q -o $(SHORT)
	$(OUT)/tractrix-bench speed --part memory,sets $(wildcard $(MOHAWK)) $(SHORT) $(BENCH)

IMAGES = $(wildcard ../shared/assets/ratboy_mohawk.tfx)
bench-image: all ## measure image error and time of every rasteriser: out/image.csv and diagrams (IMAGES=FILE...: other hair)
	@scripts/setup build run plot
	$(OUT)/tractrix-bench images $(IMAGES) --csv out/image.csv
	@scripts/plot-image out/image.csv out/image

STRESS = --cases 5000 --steps 10000 --seed 1
stress: all ## run random scenes with every solver until a rule breaks: an hour or so (STRESS="--algo chain --seed 2")
	scripts/stress $(OUT)/tractrix-bench $(STRESS)

SEED = 1
# Tests whose long forms take too long for `make test`.
LONG_TESTS = ^test_(stress\.c|pairs\.sh)
torture: all tests ## let every system call of small runs fail in turn, kill 200 runs, start 200 pairs of runs, run long tests: an hour (SEED=N, TORTURE_OPTIONS="--only convert")
	@TEST_LONG=1 tests/runner $(OUT) '$(LONG_TESTS)'
	@$(TORTURE) $(OUT) --long --seed $(SEED) --jobs $$(nproc) $(TORTURE_OPTIONS)

# Not: test_steps, because shells read scripts byte by byte and then take longer than it allows; test_mutate, whose
# sanitizers want to be loaded first; test_short_memory, which replaces malloc; tests that read and draw much, but wait for nothing.
DELAYS_BUT = ^test_(blender|docs|goldens|light_command|mutate|recorded_.*|short_memory|steps|swatches)([.]|$$)
delays: all tests $(DELAYS) ## run the tests with random delays in files and threads, as on a slow machine: three minutes (ONLY=NAME)
	@LD_PRELOAD=$(CURDIR)/$(OUT)/tests/faults/delays.so tests/runner $(OUT) '$(or $(ONLY),^test_)' '$(DELAYS_BUT)'

growth: all tests ## make 10,000 scenes and simulations and 100 devices with the library, count memory that stays: five minutes
	@TEST_ROUNDS=10000 $(OUT)/tests/library/test_library_growth

# --- Static checks and the sanitizers. All of them run, then the failed ones are named. A single one: make
# check-format.
CHECKS := commits format scripts benchmarks warnings clang cppcheck shaders gpu-statistics rounding abi release farm sanitize
C_FILES = $(wildcard src/*/*.[ch] src/*/*/*.[ch] tests/*/*.[ch] glsl/*/* tests/glsl/*)
SIDE   := $(if $(filter command line,$(origin OUT)),$(OUT)/,out/)
QUIET   = $(AGAIN) $(JOBS) --silent

check: ## run static checks, warnings of gcc and clang as errors, and the tests under sanitizers
	@scripts/setup build run test python check
	@failed=; for step in $(CHECKS); do echo "check: $$step"; \
	    $(MAKE) --no-print-directory check-$$step || failed="$$failed $$step"; done; \
	if [ "$$failed" ]; then echo "check: failed:$$failed"; exit 1; fi; echo "check: all well"

check-commits: # subjects and reasons of what the upstream branch lacks, else of the last ones (scripts/check-commits)
	@scripts/check-commits || [ $$? = 77 ]
check-format:
	@printf '%s\n' $(C_FILES) | xargs -n 64 -P $$(nproc) clang-format --dry-run -Werror
check-scripts:
	@scripts/list-shell | xargs -n 16 -P $$(nproc) shellcheck -x
check-benchmarks: # the published figures are those of these solvers and defaults
	@scripts/benchmark-stamp check
check-warnings: # where warnings are errors anyway (CI), the usual build is the check
	$(QUIET) WERROR=1 OUT=$(if $(WERROR),$(OUT),$(SIDE)check-gcc) all tests
check-clang: $(OUT)/version.h # parsed only: warnings, but no errors of code generation or linking
	@command -v clang >/dev/null || { echo "no clang here: skipped"; exit 0; }; \
	printf '%s\n' $(SOURCES) $(MAINS) $(STAND_IN) $(TESTS) $(KEEP) $(SUPPORT) $(FUZZ) $(wildcard tests/faults/*.c) | xargs -n 16 -P $$(nproc) clang $(C_FLAGS) -Werror -Itests -fsyntax-only
check-cppcheck: # readdirCalled: it asks for readdir_r, which POSIX has since withdrawn
	@mkdir -p $(SIDE)check-cppcheck
	@cppcheck --quiet --std=c11 --language=c --library=posix --enable=warning,performance,portability --inline-suppr \
	    --suppress=readdirCalled --error-exitcode=1 --cppcheck-build-dir=$(SIDE)check-cppcheck -D_GNU_SOURCE -I. -Isrc -Iglsl -Itests src tests
check-shaders:
	$(QUIET) all
	@scripts/check-shaders $(OUT) $(SIDE)shaders
check-gpu-statistics: # registers and waves on GPUs; a line says so where a package for it is missing
	$(QUIET) all
	@scripts/gpu-statistics $$([ $(SIDE)shaders -nt $(OUT)/tractrix-bench ] && echo --sources $(SIDE)shaders || echo --programs $(OUT)) || [ $$? = 77 ]
# Tests whose results depend on the driver's maths, with an error of two units in the last place in every root, power
# and angle. The sanitizers run them with the same error as on a GPU, so .ci/run gives only the others, ROUNDED_LEFT, to this check.
ROUNDED = ^test_(solver_|solvers|shadow|renderer|image_reference|collision|follow|volume|sleep|rest|carry|pose|distance_field).*\.c
ROUNDED_HERE = $(ROUNDED)
ROUNDED_LEFT = ^($(shell basename -a tests/*/test_*.c | grep -E '$(ROUNDED)' | grep -E '$(SANITIZE_BUT)' | paste -sd'|'))
check-rounding:
	$(QUIET) all tests
	@TEST_ASSUME=ulps=2 tests/runner $(OUT) '$(ROUNDED_HERE)'
drivers: all ## render with softpipe and zink, which need no GPU, and compare with llvmpipe: 20 minutes
	@scripts/setup build run gpu
	@scripts/check-drivers $(OUT)
check-farm: # GNU parallel and a Slurm of one node, which make test does without
	@scripts/setup farm
	$(QUIET) all
	@tests/runner $(OUT) test_farm
# All tests except scripts that run the programs many times, as other tests do, and tests that draw hundreds of images.
# SANITIZE_BUT=none runs all.
SANITIZE_BUT = ^test_(bench_command|bench_html|benchmark_stamp|blender|budget|ci_examples|command_cache|command_line|compare_goldens|docs|farm|faults|furnace|gen_command|goldens|gpu_report|groom_command|html_report|install|light_command|light_turned|mutate|python|readme|recorded_(images|motion|reports)|stress|swatches|turntable_images|turntable_script|tutorial|(along|clamped|shadow|solvers|volume)[.])
# Tests in C behave as on a GPU here, with maths that are one unit off, or two; `make test` runs them as this machine does.
check-sanitize:
	$(QUIET) CONFIG=sanitize OUT=$(SIDE)sanitize all tests
	@TEST_ASSUME="hardware ulps=1" tests/runner $(SIDE)sanitize test_ '$(SANITIZE_BUT)|$(ROUNDED)'
	@TEST_ASSUME="hardware ulps=2" tests/runner $(SIDE)sanitize '$(ROUNDED)' '$(SANITIZE_BUT)'
# Tests of data that threads share: parallel_run, the output's workers, the video, pairs of images, progress, leftovers,
# two devices of the library. Tests that draw hundreds of images are left out; scripts/run-threads runs the same code
# once.
THREADED = ^test_(bins|compare|composite|groom_shape|leftovers|library_device|light_grid|output|output_video|parallel|png|progress|renderer_pool|scalp|sequence|shadow_reference|strands_make|video)\.c
check-threads: export TSAN_OPTIONS = suppressions=$(CURDIR)/tests/tsan.supp exitcode=66
check-threads: ## find data races of the threaded parts by ThreadSanitizer: some minutes (ONLY=NAME)
	@scripts/setup build run test python
	$(QUIET) CONFIG=threads OUT=$(SIDE)threads all tests
	@tests/runner $(SIDE)threads '$(or $(ONLY),$(THREADED))'
	@$(if $(ONLY),,scripts/run-threads $(SIDE)threads)
check-analyzer: ## run gcc -fanalyzer over src: some minutes
	@scripts/setup build
	$(QUIET) CONFIG=analyzer WERROR=1 OUT=$(SIDE)analyzer all
check-tidy: ## run clang-tidy over src, with the checks of .clang-tidy: some minutes
	@scripts/setup build lint
	$(QUIET) all
	@scripts/check-tidy $(SIDE)tidy -std=c11 -D_GNU_SOURCE -I. -Isrc -Iglsl -I$(OUT) $(INCLUDES)

TIME = 60
fuzz: all ## feed mutated bytes to every reader, TIME seconds each [60] (ONLY="png cache": only these)
	@scripts/setup build run check
	@command -v clang >/dev/null || { echo "fuzz: no clang here: expected clang with libFuzzer" >&2; exit 1; }
	$(QUIET) CONFIG=fuzz OUT=$(SIDE)fuzz $(SIDE)fuzz/tests/fuzz/fuzz
	@scripts/fuzz --time $(TIME) $(OUT) $(SIDE)fuzz $(ONLY)

coverage: ## check that the tests run 90 % of the lines of all readers and writers (ONLY=NAME)
	@scripts/setup build run test python
	$(QUIET) CONFIG=coverage OUT=$(SIDE)coverage all tests
	@find $(SIDE)coverage -name '*.gcda' -delete
	@tests/runner $(SIDE)coverage $(ONLY)
	@scripts/coverage $(SIDE)coverage

# --- Packages. They take minutes and are not part of `make check`.
deb: ## build Debian packages in out/deb and check them with lintian
	@scripts/setup deb
	@scripts/make-deb out/deb
check-deb: deb ## install the Debian packages in a clean root, run the programs, remove them; build them again: same bytes (as root)
	@scripts/check-deb out/deb
	@umask 077; TZ=Asia/Tokyo scripts/make-deb out/deb-again/elsewhere
	@for file in out/deb/*.deb; do cmp $$file out/deb-again/elsewhere/$${file##*/} || exit 1; done; echo "check-deb: built twice, the same bytes"
# The version that the programs print.
SAID = $$(sed -n 's/.*_VERSION "\(.*\)"/\1/p' $(OUT)/version.h)
tarball: all ## pack an archive that runs where it is unpacked: out/tarball/*.tar.gz (Debian 12, Ubuntu 22.04 and newer)
	@scripts/setup python
	@rm -rf out/tarball && mkdir -p out/tarball
	+$(QUIET) install PREFIX= DESTDIR=$(CURDIR)/out/tarball/root
	@scripts/make-tarball out/tarball "$(SAID)"
wheel: all ## build the Python module with its libraries: out/wheel/*.whl
	@scripts/setup python
	@scripts/make-wheel $(OUT) out/wheel "$(SAID)"
check-release: tarball ## unpack the archive in a clean root and run the programs (as root, with mmdebstrap)
	@if [ "$$(id -u)" != 0 ] || ! command -v mmdebstrap >/dev/null; then \
	    echo "check-release: not root, or no mmdebstrap (scripts/setup deb): skipped, the archive was only made"; exit 0; fi; \
	scripts/check-tarball out/tarball/*.tar.gz
# The interface that programs built with an earlier release rely on. Of types only those that tractrix.h describes count: what its handles consist of may change.
ABI := src/library/tractrix.abi
$(OUT)/abi/libtractrix.so.0: $(LIBRARY_OBJECTS:$(OUT)/%.o=src/%.c) $(wildcard src/library/*.h) src/library/tractrix.map $(OUT)/libtractrix.a
	@mkdir -p $(@D)
	$(call run,LINK,$(CC) $(C_FLAGS) -g $(LD_FLAGS) $(SHARED) -o $@ $(filter %.c,$^) $(OUT)/libtractrix.a $(LD_LIBS))
ABIDW = abidw --header-file src/library/tractrix.h --drop-private-types --no-corpus-path --no-comp-dir-path --no-show-locs --no-write-default-sizes --no-elf-needed
check-abi: $(OUT)/abi/libtractrix.so.0
	@command -v abidiff >/dev/null || { echo "no abidiff here: skipped"; exit 0; }; \
	$(ABIDW) --out-file $<.abi $< && abidiff --no-added-syms $(ABI) $<.abi || \
	    { echo "check-abi: programs may no longer run: expected new functions and members at the end of structs; make update-abi once that is so"; exit 1; }
update-abi: $(OUT)/abi/libtractrix.so.0
	@$(ABIDW) --out-file $(ABI) $<
check-container: ## run the steps of the Containerfile without a container engine (as root)
	@scripts/setup deb
	@scripts/check-container

format: ## run clang-format on all C and GLSL files
	clang-format -i $(C_FILES)

# --- Installation.
BIN_DIR = $(DESTDIR)$(PREFIX)/bin
LIB_DIR = $(DESTDIR)$(LIBDIR)
INCLUDE_DIR = $(DESTDIR)$(PREFIX)/include
SHARE_DIR = $(DESTDIR)$(PREFIX)/share
MAN_DIR = $(SHARE_DIR)/man/man1
DATA_DIR = $(SHARE_DIR)/tractrix
DOC_DIR = $(SHARE_DIR)/doc/tractrix
bash_DIR = $(SHARE_DIR)/bash-completion/completions
fish_DIR = $(SHARE_DIR)/fish/vendor_completions.d
zsh_DIR = $(SHARE_DIR)/zsh/$(ZSH_FOLDER)
ZSH_FOLDER ?= site-functions
# The folder for the completion FILE, PROGRAM.SHELL; each shell has its own names.
shell_of = $(patsubst .%,%,$(suffix $(1)))
completion_of = $($(shell_of)_DIR)/$(patsubst %,$(completion_name_$(shell_of)),$(basename $(notdir $(1))))
completion_name_bash := %
completion_name_fish := %.fish
completion_name_zsh := _%
EXAMPLES := $(wildcard examples/* examples/*/* examples/*/*/*)

# Programs find a new library in a system's folder once ldconfig has seen it. A package's scripts do this later (DESTDIR).
REFRESH := [ "$(DESTDIR)" ] || ! PATH=$$PATH:/usr/sbin:/sbin ldconfig -N -v 2>/dev/null | grep -q '^$(LIBDIR):' || \
    PATH=$$PATH:/usr/sbin:/sbin ldconfig || echo "install: run ldconfig as root: programs do not find libtractrix.so.0 before that" >&2

install: all $(MANUALS) $(COMPLETIONS) ## install programs, library, manuals, completion, docs, assets and examples under $(DESTDIR)$(PREFIX)
	install -d $(BIN_DIR) $(MAN_DIR) $(bash_DIR) $(fish_DIR) $(zsh_DIR) $(DATA_DIR) $(DOC_DIR)/docs
	install $(PROGRAMS) $(SCRIPTS) $(BIN_DIR)
	install -d $(LIB_DIR)/pkgconfig $(LIB_DIR)/cmake/tractrix $(INCLUDE_DIR)
	install -m 644 $(OUT)/lib/libtractrix.so.0 $(OUT)/lib/libtractrix.a $(LIB_DIR)
	ln -sf libtractrix.so.0 $(LIB_DIR)/libtractrix.so
	install -m 644 $(OUT)/lib/pkgconfig/tractrix.pc $(LIB_DIR)/pkgconfig
	install -m 644 $(addprefix $(OUT)/lib/,$(CMAKE_FILES)) $(LIB_DIR)/cmake/tractrix
	install -m 644 src/library/tractrix.h $(INCLUDE_DIR)
	install -m 644 scripts/blender_hair.py $(DATA_DIR)
	install -m 644 $(MANUALS) $(MAN_DIR)
	$(foreach file,$(COMPLETIONS),install -m 644 $(file) $(call completion_of,$(file)) &&) true
	install -m 644 $(wildcard assets/*) $(DATA_DIR)
	install -m 644 LICENSE README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff $(DOC_DIR)
	install -m 644 $(wildcard docs/*.*) $(DOC_DIR)/docs
	$(if $(wildcard docs/benchmarks/*.csv),install -D -m 644 -t $(DOC_DIR)/docs/benchmarks $(wildcard docs/benchmarks/*.csv))
	install -D -m 644 -t $(DOC_DIR)/docs/notes $(wildcard docs/notes/*.md)
	ln -sfn ../../tractrix $(DOC_DIR)/assets
	$(foreach file,$(EXAMPLES),$(if $(wildcard $(file)/.),,install -D -m $(if $(shell test -x $(file) && echo x),755,644) $(file) $(DOC_DIR)/$(file) &&)) true
	@$(REFRESH)

uninstall: ## remove what `make install` installed
	rm -f $(addprefix $(LIB_DIR)/,$(LIBRARY:$(OUT)/lib/%=%)) $(INCLUDE_DIR)/tractrix.h
	rm -f $(addprefix $(BIN_DIR)/,$(notdir $(PROGRAMS) $(SCRIPTS))) $(addprefix $(MAN_DIR)/,$(notdir $(MANUALS)))
	rm -f $(foreach file,$(COMPLETIONS),$(call completion_of,$(file)))
	rm -rf $(DATA_DIR) $(DOC_DIR) $(LIB_DIR)/cmake/tractrix
	@$(REFRESH)
	for folder in $(bash_DIR) $(fish_DIR) $(zsh_DIR); do rmdir $$folder $$(dirname $$folder) 2>/dev/null || true; done

clean: ## remove out/
	rm -rf out

help: ## print this list
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  make \1\t\2/p' $(firstword $(MAKEFILE_LIST)) | expand -t 24
	@echo; sed -n '4,8s/^#//p' $(firstword $(MAKEFILE_LIST))

FORCE:
.PHONY: library deb check-deb tarball wheel update-abi check-container drivers all tests faults demo test bench bench-image stress torture delays growth check $(CHECKS:%=check-%) check-threads check-analyzer check-tidy format install uninstall clean help FORCE
.SECONDARY:
.DELETE_ON_ERROR:
-include $(wildcard $(OUT)/*.d $(OUT)/*/*.d $(OUT)/*/*/*.d)
