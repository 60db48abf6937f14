// SPDX-License-Identifier: MIT
// The platform's name differs where rounding differs, and is equal otherwise.
#include "gpu/platform.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static void names_tell_drivers_and_devices(void **state)
{
    (void)state;
    static const struct {
        PlatformFacts facts;
        const char *name;
    } cases[] = {
        {{"Mesa/X.org", "llvmpipe (LLVM 15.0.6, 256 bits)", "4.5 (Core Profile) Mesa 22.3.6",
          "x86_64", true, true, false},
         "llvmpipe-mesa22.3-llvm15-256-fma-x86_64"},
        {{"Mesa", "llvmpipe (LLVM 19.1.1, 128 bits)", "4.5 (Core Profile) Mesa 24.2.8-1ubuntu1",
          "x86_64", true, false, false},
         "llvmpipe-mesa24.2-llvm19-128-x86_64"},
        {{"Mesa", "llvmpipe (LLVM 15.0.6, 256 bits) assumed to be hardware", "4.5 Mesa 22.3.6",
          "x86_64", true, true, true},
         "gpu-llvmpipe-mesa22.3-llvm15-256-fma-x86_64"},
        {{"Mesa", "softpipe", "4.3 Mesa 22.3.6", "aarch64", true, true, false},
         "softpipe-mesa22.3-fma-aarch64"},
        {{"NVIDIA Corporation", "NVIDIA H100 80GB HBM3/PCIe/SSE2", "4.6.0 NVIDIA 550.90.07",
          "x86_64", false, true, false},
         "nvidia-h100-80gb-hbm3-550"},
        {{"AMD", "AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.7, DRM 3.54)",
          "4.6 (Core Profile) Mesa 23.2.1", "x86_64", false, true, false},
         "amd-radeon-rx-6800-mesa23.2"},
        {{"Intel", "Mesa Intel(R) UHD Graphics 630 (CFL GT2)", "4.6 (Core Profile) Mesa 23.2.1",
          "x86_64", false, true, false},
         "intel-uhd-graphics-630-mesa23.2"},
        {{"Imagination/../x", "Power VR;$(x)", "4.6 build 1.17", "x86_64", false, true, false},
         "gpu-power-vr-x"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char name[PLATFORM_BYTES];
        platform_name(name, &cases[i].facts);
        assert_string_equal(name, cases[i].name);
    }
}

static void a_long_name_is_cut(void **state)
{
    (void)state;
    char name[PLATFORM_BYTES], renderer[400];
    memset(renderer, 'x', sizeof renderer);
    renderer[sizeof renderer - 1] = 0;
    const PlatformFacts facts = {"v", renderer, "4.6 Mesa 22.3.6", "x86_64", false, true, false};
    platform_name(name, &facts);
    assert_int_equal(strlen(name), PLATFORM_BYTES - 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(names_tell_drivers_and_devices),
                                       cmocka_unit_test(a_long_name_is_cut)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
