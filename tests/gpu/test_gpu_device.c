// SPDX-License-Identifier: MIT
// Equal GPUs are told apart by the system's data, and messages explain why a GPU can't be used. No
// GPU is needed for this: the test imitates the system's folders. The devices that there are open
// by number, and in their order.
#include "gpu/gpu.h"
#include "gpu/gpu_device.h"
#include "gpu/gpu_egl.h"
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

// Tries a device as the option --device does. Returns whether it opens, and its path.
static bool opens(const GpuOptions *options, char path[64], bool *software, Error *error)
{
    Gpu gpu;
    Result result = gpu_create(&gpu, options, error);
    if (result != RESULT_OK) {
        assert_int_equal(result, RESULT_NO_GL);
        return false;
    }
    snprintf(path, 64, "%s", gpu.path);
    *software = gpu.software;
    gpu_destroy(&gpu);
    return true;
}

// Each device with a context opens by its number, whatever its kind, or the message says why it
// does not. Without a name the first device that works is taken, a hardware device before a CPU
// driver; EGL without a device comes after all of them.
static void devices_open_by_number_and_in_their_order(void **state)
{
    GpuDevices devices = {0};
    Error error = {{0}};
    char path[64], first[2][64] = {"", ""}; // of hardware, of CPU drivers
    bool software;
    (void)state;
    if (gpu_egl_find_devices(&devices, &error) != RESULT_OK) skip();
    for (int i = 0; i < devices.count; ++i) {
        char number[16], expected[64], *kind = first[devices.device[i].software];
        EglContext context;
        if (gpu_egl_create(&context, devices.device[i].egl, false, &error) != RESULT_OK) continue;
        gpu_egl_destroy(&context);
        snprintf(number, sizeof number, "%d", i);
        snprintf(expected, sizeof expected, "EGL device %d", i);
        const GpuOptions options = {.backend = BACKEND_EGL, .device = number};
        if (opens(&options, path, &software, &error)) {
            assert_string_equal(path, expected);
            if (!*kind) snprintf(kind, 64, "%s", path);
        } else if (!strstr(error.text, expected)) {
            fail_msg("'%s' lacks '%s'", error.text, expected);
        }
    }
    if (!*first[0] && !*first[1]) skip();
    GpuOptions options = {.backend = BACKEND_EGL};
    assert_true(opens(&options, path, &software, &error));
    assert_string_equal(path, *first[0] ? first[0] : first[1]);
    if (!*first[1]) return;
    options.software = true;
    assert_true(opens(&options, path, &software, &error));
    assert_string_equal(path, first[1]);
    assert_true(software);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        TEST(a_node_has_the_address_of_its_pci_device),
        TEST(a_device_is_named_by_what_its_list_shows),
        TEST(a_gpu_that_cannot_be_used_is_explained),
        TEST(devices_open_by_number_and_in_their_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
