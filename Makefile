# SPDX-License-Identifier: MIT
# Tractrix: headless hair simulator and renderer. `make help` lists the targets.

CONFIG ?= release
OUT    := out/$(CONFIG)
CC     ?= gcc

PACKAGES := epoxy egl cglm libdeflate jansson stb
CPPFLAGS += -D_GNU_SOURCE -Isrc -Iglsl $(shell pkg-config --cflags $(PACKAGES) 2>/dev/null)
CFLAGS_release  := -O2 -DNDEBUG
CFLAGS_debug    := -O0 -g3 -DTRACTRIX_DEBUG
CFLAGS_sanitize := -O1 -g -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined
LDFLAGS_sanitize := -fsanitize=address,undefined
CFLAGS  += -std=c11 -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wvla -ffp-contract=off -pthread $(CFLAGS_$(CONFIG))
LDFLAGS += $(LDFLAGS_$(CONFIG)) -pthread
LDLIBS  += $(shell pkg-config --libs epoxy egl libdeflate jansson 2>/dev/null) -ldl -lm

PROGRAMS := tractrix-render tractrix-gen tractrix-bench
MAINS    := $(wildcard src/main_*.c)
SOURCES  := $(filter-out $(MAINS),$(wildcard src/*.c))
OBJECTS  := $(SOURCES:src/%.c=$(OUT)/%.o) $(OUT)/glsl_sources.o
SHADERS  := $(wildcard glsl/*)
BINARIES := $(MAINS:src/main_%.c=$(OUT)/tractrix-%)
TESTS    := $(patsubst tests/%.c,$(OUT)/tests/%,$(wildcard tests/test_*.c))

all: $(BINARIES)

$(OUT)/%.o: src/%.c | $(OUT)
	$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<
$(OUT)/glsl_sources.c: scripts/embed-glsl $(SHADERS) | $(OUT)
	scripts/embed-glsl $(SHADERS) >$@.tmp && mv $@.tmp $@
$(OUT)/glsl_sources.o: $(OUT)/glsl_sources.c
	$(CC) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<
$(OUT)/libtractrix.a: $(OBJECTS)
	rm -f $@ && $(AR) rcs $@ $(OBJECTS)
$(OUT)/tractrix-%: $(OUT)/main_%.o $(OUT)/libtractrix.a
	$(CC) $(LDFLAGS) -o $@ $^ $(LDLIBS)
$(OUT)/tests/%: tests/%.c $(OUT)/libtractrix.a | $(OUT)
	$(CC) $(CPPFLAGS) -Itests $(CFLAGS) -MMD -MP $(LDFLAGS) -o $@ $(filter %.c %.a,$^) $(LDLIBS) -lcmocka
$(OUT):
	mkdir -p $@/tests

clean:
	rm -rf out

.PHONY: all clean
-include $(wildcard $(OUT)/*.d $(OUT)/tests/*.d)
