// SPDX-License-Identifier: MIT
// Equal GPUs are told apart by the system's data, and messages explain why a GPU can't be used. No
// GPU is needed: the test imitates the system's folders.
#include "gpu/gpu_device.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static void make_folder(void **state, const char *name)
{
    assert_int_equal(mkdir(temporary_path(state, name), 0777), 0);
}

static void a_node_has_the_address_of_its_pci_device(void **state)
{
    static const char *const folders[] = {"dev",       "dev/char",       "dev/char/226:128",
                                          "devices",   "devices/pci",    "devices/pci/0000:c1:00.0",
                                          "devices/x", "dev/char/226:64"};
    char pci[32] = "";
    for (size_t i = 0; i < sizeof folders / sizeof *folders; ++i) make_folder(state, folders[i]);
    assert_int_equal(symlink("../../../devices/pci/0000:c1:00.0",
                             temporary_path(state, "dev/char/226:128/device")),
                     0);
    assert_int_equal(symlink("../../../devices/x", temporary_path(state, "dev/char/226:64/device")),
                     0);
    const char *sys = temporary_path(state, ".");
    assert_true(gpu_device_find_pci(sys, 226, 128, pci));
    assert_string_equal(pci, "0000:c1:00.0");
    assert_false(gpu_device_find_pci(sys, 226, 64, pci)); // not a PCI device but part of a board
    assert_false(gpu_device_find_pci(sys, 1, 1, pci));
}

static void a_device_is_named_by_what_its_list_shows(void **state)
{
    (void)state;
    const GpuIdentity identity = {.node = "/dev/dri/renderD129",
                                  .pci = "0000:c1:00.0",
                                  .uuid = "8a1b2c3d-0000-0000-0000-000000000001"};
    const char *renderer = "AMD Radeon RX 6800 (navi21, LLVM 15.0.6)", *vendor = "AMD";
    static const struct {
        const char *name;
        bool meant;
    } cases[] = {{"1", true},
                 {"0", false},
                 {"11", false},
                 {"radeon", true},
                 {"Radeon RX 6800", true},
                 {"NVIDIA", false},
                 {"amd", true},
                 {"0000:c1:00.0", true},
                 {"C1:00.0", true},
                 {"c1:00", false},
                 {"0001:c1:00.0", false},
                 {"/dev/dri/renderD129", true},
                 {"/dev/dri/renderD12", false},
                 {"8A1B", true},
                 {"8a1b2c3d-0000-0000-0000-000000000002", false},
                 {"8a1", false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
        if (gpu_device_is(cases[i].name, 1, renderer, vendor, &identity) != cases[i].meant)
            fail_msg("%s", cases[i].name);
    // Unknown data matches no GPU.
    assert_false(gpu_device_is("c1:00.0", 1, renderer, vendor, &(GpuIdentity){0}));
}

static void a_gpu_that_cannot_be_used_is_explained(void **state)
{
    Error why;
    const char *dev = temporary_path(state, "devices-of-a-machine");
    make_folder(state, "devices-of-a-machine");
    gpu_device_explain(dev, &why);
    assert_string_equal(why.text, "");
    temporary_write(state, "devices-of-a-machine/nvidiactl", "", 0666);
    gpu_device_explain(dev, &why);
    assert_non_null(strstr(why.text, "no device file of a GPU"));
    temporary_write(state, "devices-of-a-machine/nvidia0", "", 0666);
    gpu_device_explain(dev, &why);
    assert_non_null(strstr(why.text, "capability 'graphics'"));
    make_folder(state, "devices-of-a-machine/dri");
    temporary_write(state, "devices-of-a-machine/dri/renderD128", "", 0666);
    gpu_device_explain(dev, &why);
    assert_non_null(strstr(why.text, "libgl1-mesa-dri"));
    if (geteuid() == 0) {
        puts("skipped: no file is closed to root");
        return;
    }
    chmod(temporary_path(state, "devices-of-a-machine/dri/renderD128"), 0);
    gpu_device_explain(dev, &why);
    assert_non_null(strstr(why.text, "Permission denied"));
    assert_non_null(strstr(why.text, "'render'"));
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        TEST(a_node_has_the_address_of_its_pci_device),
        TEST(a_device_is_named_by_what_its_list_shows),
        TEST(a_gpu_that_cannot_be_used_is_explained),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
