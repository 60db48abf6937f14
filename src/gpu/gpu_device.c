// SPDX-License-Identifier: MIT
#include "gpu/gpu_device.h"

#include <epoxy/gl.h>

#include <errno.h>
#include <glob.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

// "0000:01:00.0"
static bool is_pci(const char *text)
{
    unsigned domain, bus, slot, function;
    int end = 0;
    return sscanf(text, "%4x:%2x:%2x.%1x%n", &domain, &bus, &slot, &function, &end) == 4 &&
           end > 0 && !text[end];
}

bool gpu_device_find_pci(const char *sys, unsigned major, unsigned minor, char pci[32])
{
    char path[PATH_MAX], target[PATH_MAX];
    snprintf(path, sizeof path, "%s/dev/char/%u:%u/device", sys, major, minor);
    if (!realpath(path, target)) return false;
    const char *name = strrchr(target, '/') + 1;
    if (!is_pci(name)) return false;
    snprintf(pci, 32, "%.31s", name);
    return true;
}

void gpu_device_look_up(GpuDevice *device)
{
    struct stat node;
    if (!*device->node || stat(device->node, &node) != 0 || !S_ISCHR(node.st_mode)) return;
    gpu_device_find_pci("/sys", major(node.st_rdev), minor(node.st_rdev), device->pci);
}

static void read_uuid(char uuid[40])
{
    GLubyte bytes[GL_UUID_SIZE_EXT] = {0};
    if (!epoxy_has_gl_extension("GL_EXT_memory_object")) return;
    GLint count = 0;
    glGetIntegerv(GL_NUM_DEVICE_UUIDS_EXT, &count);
    if (count < 1) return;
    glGetUnsignedBytei_vEXT(GL_DEVICE_UUID_EXT, 0, bytes);
    char *at = uuid;
    for (int i = 0; i < GL_UUID_SIZE_EXT; ++i) {
        if (i == 4 || i == 6 || i == 8 || i == 10) *at++ = '-';
        at += sprintf(at, "%02x", bytes[i]);
    }
}

static int64_t read_memory(void)
{
    GLint kib = 0;
    if (epoxy_has_gl_extension("GL_NVX_gpu_memory_info"))
        glGetIntegerv(GL_GPU_MEMORY_INFO_DEDICATED_VIDMEM_NVX, &kib);
    return kib > 0 ? (int64_t)kib * 1024 : 0;
}

GpuIdentity gpu_device_identify(const GpuDevice *device)
{
    GpuIdentity identity = {.memory = read_memory()};
    read_uuid(identity.uuid);
    if (device) {
        memcpy(identity.node, device->node, sizeof identity.node);
        memcpy(identity.pci, device->pci, sizeof identity.pci);
    }
    return identity;
}

static bool is_number(const char *name)
{
    return *name && strspn(name, "0123456789") == strlen(name);
}

bool gpu_device_is(const char *name, int number, const char *renderer, const char *vendor,
                   const GpuIdentity *identity)
{
    const char *pci = identity->pci, *bus = *pci ? strchr(pci, ':') + 1 : pci;
    size_t length = strlen(name);
    if (is_number(name)) return strtol(name, NULL, 10) == number;
    return strcasestr(renderer, name) || strcasestr(vendor, name) ||
           (*pci && (strcasecmp(name, pci) == 0 || strcasecmp(name, bus) == 0)) ||
           (*identity->node && strcmp(name, identity->node) == 0) ||
           (length >= 4 && strncasecmp(name, identity->uuid, length) == 0);
}

// The first path under `dev` that matches the pattern; false if there is none.
static bool find_node(const char *dev, const char *pattern, char path[PATH_MAX])
{
    char whole[PATH_MAX];
    glob_t found;
    snprintf(whole, sizeof whole, "%s/%s", dev, pattern);
    bool any = glob(whole, 0, NULL, &found) == 0 && found.gl_pathc > 0;
    if (any) snprintf(path, PATH_MAX, "%s", found.gl_pathv[0]);
    globfree(&found);
    return any;
}

void gpu_device_explain(const char *dev, Error *why)
{
    char node[PATH_MAX];
    why->text[0] = 0;
    if (find_node(dev, "dri/renderD*", node)) {
        if (access(node, R_OK | W_OK) != 0)
            error_set(why, RESULT_NO_GL,
                      "%s: %s (on Debian, members of the group 'render' may open it)", node,
                      strerror(errno));
        else
            error_set(why, RESULT_NO_GL,
                      "%s has no OpenGL driver here (on Debian: libgl1-mesa-dri)", node);
    } else if (find_node(dev, "nvidia[0-9]*", node)) {
        error_set(why, RESULT_NO_GL,
                  "%s has no EGL driver here (libEGL_nvidia.so.0; in a container: the driver "
                  "capability 'graphics')",
                  node);
    } else if (find_node(dev, "nvidiactl", node)) {
        error_set(why, RESULT_NO_GL,
                  "%s is there, but there is no device file of a GPU (/dev/nvidia0)", node);
    }
}
