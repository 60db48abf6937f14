// SPDX-License-Identifier: MIT
// Statistics of compute shaders by Mesa's compiler for AMD GPUs, without such a GPU: RADV's null
// device (RADV_FORCE_FAMILY) compiles as for a real one, and VK_KHR_pipeline_executable_properties
// reports registers, scratch memory and waves. scripts/gpu-statistics builds and runs it.
//
// usage: shader_statistics FILE.spv...
// Prints the device's name, then for each file its name and NAME=VALUE of every statistic,
// separated by tabs; "refused" if the driver can't create a pipeline of it. Status 1 if any was
// refused, 3 without such a device.
#include <vulkan/vulkan.h>

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BINDINGS = 64, MOST_STATISTICS = 64, MOST_DEVICES = 16, NO_DEVICE = 3 };

// SPIR-V 1.0: operations, decorations, storage classes.
enum {
    OP_TYPE_IMAGE = 25,
    OP_TYPE_SAMPLED_IMAGE = 27,
    OP_TYPE_POINTER = 32,
    OP_VARIABLE = 59,
    OP_DECORATE = 71,
    BUFFER_BLOCK = 3,
    BINDING = 33,
    CLASS_UNIFORM = 2,
    CLASS_STORAGE_BUFFER = 12,
    DIMENSION_BUFFER = 5,
    STORAGE_IMAGE = 2
};

typedef struct Module {
    uint32_t *words;
    size_t count; // of words
} Module;

// What a module says about one of its ids; 0 if nothing.
typedef struct Id {
    uint32_t pointee, image; // ids: what a pointer points to; the image of a sampled image
    uint32_t binding;
    bool bound, is_buffer_block;
    uint32_t dimension, sampled; // of an image type
} Id;

static bool module_read(Module *module, const char *path)
{
    FILE *file = fopen(path, "rb");
    long size = -1;
    *module = (Module){NULL, 0};
    if (file && fseek(file, 0, SEEK_END) == 0) size = ftell(file);
    if (size >= 20 && size % 4 == 0 && fseek(file, 0, SEEK_SET) == 0) {
        module->words = malloc((size_t)size);
        if (module->words) module->count = fread(module->words, 4, (size_t)size / 4, file);
    }
    if (file) fclose(file);
    return module->count > 0 && module->count == (size_t)size / 4;
}

static void ids_note(Id *ids, const uint32_t *w, uint32_t operation)
{
    switch (operation) {
    case OP_DECORATE:
        if (w[2] == BINDING) ids[w[1]].bound = true, ids[w[1]].binding = w[3];
        if (w[2] == BUFFER_BLOCK) ids[w[1]].is_buffer_block = true;
        break;
    case OP_TYPE_IMAGE:
        ids[w[1]].dimension = w[3], ids[w[1]].sampled = w[7];
        break;
    case OP_TYPE_SAMPLED_IMAGE:
        ids[w[1]].image = w[2];
        break;
    case OP_TYPE_POINTER:
        ids[w[1]].pointee = w[3];
        break;
    default:
        break;
    }
}

static VkDescriptorType type_of(const Id *ids, uint32_t type, uint32_t storage)
{
    const Id *id = &ids[type], *image = id->image ? &ids[id->image] : id;
    if (storage == CLASS_STORAGE_BUFFER || id->is_buffer_block)
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    if (storage == CLASS_UNIFORM) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    if (image->dimension == DIMENSION_BUFFER)
        return image->sampled == STORAGE_IMAGE ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER
                                               : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    return image->sampled == STORAGE_IMAGE ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                           : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

// Finds the bindings of a module by glslangValidator, which is assumed to be valid. Returns their
// count; -1 if there are too many or memory is short.
static int find_bindings(const Module *module, VkDescriptorSetLayoutBinding *bindings)
{
    Id *ids = calloc(module->words[3], sizeof *ids); // words[3]: the bound of ids
    int count = ids ? 0 : -1;
    for (size_t i = 5; ids && count >= 0 && i < module->count; i += module->words[i] >> 16) {
        const uint32_t *w = &module->words[i], operation = w[0] & 0xffff;
        ids_note(ids, w, operation);
        if (operation != OP_VARIABLE || !ids[w[2]].bound) continue;
        if (count == MOST_BINDINGS) {
            count = -1;
            break;
        }
        bindings[count++] = (VkDescriptorSetLayoutBinding){
            .binding = ids[w[2]].binding,
            .descriptorType = type_of(ids, ids[w[1]].pointee, w[3]),
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
    }
    free(ids);
    return count;
}

typedef struct Driver {
    VkInstance instance;
    VkDevice device;
    PFN_vkGetPipelineExecutablePropertiesKHR properties;
    PFN_vkGetPipelineExecutableStatisticsKHR statistics;
} Driver;

static VkResult create_device(Driver *driver, VkPhysicalDevice physical)
{
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pipelineExecutableInfo = VK_TRUE};
    const char *const extensions[] = {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = 1,
                                     .ppEnabledExtensionNames = extensions};
    return vkCreateDevice(physical, &info, NULL, &driver->device);
}

// The device that RADV_FORCE_FAMILY selects, by its name; VK_NULL_HANDLE if there is none.
static VkPhysicalDevice find_device(VkInstance instance)
{
    VkPhysicalDevice devices[MOST_DEVICES];
    uint32_t count = MOST_DEVICES;
    const char *family = getenv("RADV_FORCE_FAMILY");
    if (!family || vkEnumeratePhysicalDevices(instance, &count, devices) < 0) return VK_NULL_HANDLE;
    for (uint32_t i = 0; i < count; ++i) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (!strstr(properties.deviceName, family)) continue;
        printf("%s\n", properties.deviceName);
        return devices[i];
    }
    return VK_NULL_HANDLE;
}

static bool driver_open(Driver *driver)
{
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "shader_statistics",
                                           .apiVersion = VK_API_VERSION_1_1};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pApplicationInfo = &application};
    if (vkCreateInstance(&info, NULL, &driver->instance)) return false;
    VkPhysicalDevice physical = find_device(driver->instance);
    if (!physical || create_device(driver, physical)) return false;
    driver->statistics = (PFN_vkGetPipelineExecutableStatisticsKHR)vkGetDeviceProcAddr(
        driver->device, "vkGetPipelineExecutableStatisticsKHR");
    driver->properties = (PFN_vkGetPipelineExecutablePropertiesKHR)vkGetDeviceProcAddr(
        driver->device, "vkGetPipelineExecutablePropertiesKHR");
    return driver->statistics && driver->properties;
}

static VkPipelineLayout create_layout(VkDevice device, const Module *module)
{
    VkDescriptorSetLayoutBinding bindings[MOST_BINDINGS];
    VkDescriptorSetLayout set = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    int count = find_bindings(module, bindings);
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = (uint32_t)(count < 0 ? 0 : count),
        .pBindings = bindings};
    const VkPipelineLayoutCreateInfo pipeline = {.sType =
                                                     VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                                 .setLayoutCount = 1,
                                                 .pSetLayouts = &set};
    if (count < 0 || vkCreateDescriptorSetLayout(device, &info, NULL, &set)) return VK_NULL_HANDLE;
    if (vkCreatePipelineLayout(device, &pipeline, NULL, &layout)) return VK_NULL_HANDLE;
    return layout;
}

static VkPipeline create_pipeline(VkDevice device, const Module *module)
{
    VkShaderModule shader = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkShaderModuleCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                           .codeSize = 4 * module->count,
                                           .pCode = module->words};
    VkPipelineLayout layout = create_layout(device, module);
    if (!layout || vkCreateShaderModule(device, &info, NULL, &shader)) return VK_NULL_HANDLE;
    const VkComputePipelineCreateInfo compute = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = shader,
                  .pName = "main"},
        .layout = layout};
    if (vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &compute, NULL, &pipeline))
        return VK_NULL_HANDLE;
    return pipeline;
}

// Lanes per wave.
static uint32_t wave_size(const Driver *driver, VkPipeline pipeline)
{
    const VkPipelineInfoKHR info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR,
                                    .pipeline = pipeline};
    VkPipelineExecutablePropertiesKHR properties = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR};
    uint32_t count = 1;
    VkResult result = driver->properties(driver->device, &info, &count, &properties);
    return result >= 0 && count == 1 ? properties.subgroupSize : 0;
}

// Objects are never destroyed: the process is short-lived.
static bool print_statistics(const Driver *driver, const char *path)
{
    Module module;
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkPipelineExecutableStatisticKHR statistics[MOST_STATISTICS] = {{0}};
    uint32_t count = MOST_STATISTICS;
    if (module_read(&module, path)) pipeline = create_pipeline(driver->device, &module);
    const VkPipelineExecutableInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline};
    for (int i = 0; i < MOST_STATISTICS; ++i)
        statistics[i].sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    bool good = pipeline && driver->statistics(driver->device, &info, &count, statistics) == 0;
    printf("%s", path);
    if (good) printf("\tLanes=%u", wave_size(driver, pipeline));
    for (uint32_t i = 0; i < count && good; ++i)
        printf("\t%s=%llu", statistics[i].name, (unsigned long long)statistics[i].value.u64);
    printf("%s\n", good ? "" : "\trefused");
    fflush(stdout);
    free(module.words);
    return good;
}

int main(int argc, char **argv)
{
    Driver driver = {0};
    bool good = true;
    if (!driver_open(&driver)) {
        fprintf(stderr,
                "shader_statistics: no device: expected Mesa's RADV and RADV_FORCE_FAMILY\n");
        return NO_DEVICE;
    }
    for (int i = 1; i < argc; ++i) good = print_statistics(&driver, argv[i]) && good;
    return good ? 0 : 1;
}
