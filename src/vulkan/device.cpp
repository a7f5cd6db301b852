// Instance and device creation, the choice of a device by name, and the validation layer's
// messages.
#include "src/vulkan/device.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "generator/base/nearest.h"
#include "src/vulkan/device_state.h"

namespace intaglio::vulkan {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
// In order of their time.  A name that RADV does not know ends the process.
constexpr std::string_view known_chips[] = {"tahiti", "hawaii", "tonga",  "polaris10", "vega10",
                                            "raven",  "navi10", "navi14", "navi21",    "vangogh"};
constexpr const char* no_device_hint =
    "hint: install a Vulkan driver, such as lavapipe from Debian's mesa-vulkan-drivers";

VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                            VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data,
                                            void* user) {
    auto& log = *static_cast<MessageLog*>(user);
    const std::lock_guard lock(log.mutex);
    log.messages.emplace_back(data->pMessage ? data->pMessage : "");
    return VK_FALSE;
}

// Only what the layer says about our use; the loader's talk about drivers without a device is of
// another type.
VkDebugUtilsMessengerCreateInfoEXT messenger_info(MessageLog* log) {
    return {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            .pNext = nullptr,
            .flags = 0,
            .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
            .pfnUserCallback = keep_message,
            .pUserData = log};
}

bool has_validation_layer() {
    std::uint32_t count = 0;
    if (vkEnumerateInstanceLayerProperties(&count, nullptr) != VK_SUCCESS) return false;
    std::vector<VkLayerProperties> layers(count);
    if (vkEnumerateInstanceLayerProperties(&count, layers.data()) != VK_SUCCESS) return false;
    return std::any_of(layers.begin(), layers.end(), [](const auto& layer) {
        return std::strcmp(layer.layerName, validation_layer) == 0;
    });
}

Diagnostic no_vulkan_device(std::string sentence) {
    Diagnostic error = input_error("no-vulkan-device", std::move(sentence));
    error.notes.emplace_back(no_device_hint);
    return error;
}

Failure attach_messenger(InstanceState& state) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(state.instance, "vkCreateDebugUtilsMessengerEXT"));
    if (!create)
        return input_error("no-validation-layer", "the validation layer cannot report messages");
    const VkDebugUtilsMessengerCreateInfoEXT info = messenger_info(state.log.get());
    return check(create(state.instance, &info, nullptr, &state.messenger),
                 "listen to the validation layer");
}

Result<std::unique_ptr<InstanceState>> make_instance(bool validation) {
    if (validation && !has_validation_layer()) {
        return input_error("no-validation-layer",
                           fmt::format("validation was asked for and {} is not installed (Debian: "
                                       "vulkan-validationlayers)",
                                       validation_layer));
    }
    std::uint32_t loader_version = VK_API_VERSION_1_0;
    vkEnumerateInstanceVersion(&loader_version);

    auto state = std::make_unique<InstanceState>();
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "intaglio";
    application.apiVersion = std::min<std::uint32_t>(loader_version, VK_API_VERSION_1_3);

    VkDebugUtilsMessengerCreateInfoEXT during_creation = messenger_info(state->log.get());
    const VkValidationFeatureEnableEXT synchronization =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.pNext = &during_creation;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronization;
    const char* const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                      VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};

    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (validation) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &validation_layer;
        info.enabledExtensionCount = static_cast<std::uint32_t>(std::size(extensions));
        info.ppEnabledExtensionNames = extensions;
    }
    const VkResult result = vkCreateInstance(&info, nullptr, &state->instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        return no_vulkan_device("no Vulkan driver is installed");
    if (auto failure = check(result, "create a Vulkan instance")) return *failure;
    if (validation) {
        if (auto failure = attach_messenger(*state)) return *failure;
    }
    return state;
}

// Drivers, and the layer once it was used, stay loaded until the process ends, held by one bare
// instance each.  Both keep memory beyond their devices; unloaded with the last of them they would
// lose it anew for each Device.
void keep_loaded(bool validation) {
    const auto bare_instance = [](std::uint32_t layers) {
        VkInstanceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
        info.enabledLayerCount = layers;
        info.ppEnabledLayerNames = &validation_layer;
        VkInstance instance = VK_NULL_HANDLE;
        return vkCreateInstance(&info, nullptr, &instance) == VK_SUCCESS ? instance
                                                                         : VK_NULL_HANDLE;
    };
    [[maybe_unused]] static const VkInstance drivers = bare_instance(0);
    if (!validation) return;
    [[maybe_unused]] static const VkInstance layer = bare_instance(1);
}

Result<std::vector<VkPhysicalDevice>> physical_devices(VkInstance instance) {
    std::uint32_t count = 0;
    std::vector<VkPhysicalDevice> devices;
    VkResult result = vkEnumeratePhysicalDevices(instance, &count, nullptr);
    if (result == VK_SUCCESS) {
        devices.resize(count);
        result = vkEnumeratePhysicalDevices(instance, &count, devices.data());
        devices.resize(count);
    }
    // Loaders report drivers that fail to start as a failed initialisation rather than as no
    // device.
    if (result == VK_ERROR_INITIALIZATION_FAILED || (result == VK_SUCCESS && devices.empty())) {
        return no_vulkan_device("the installed Vulkan drivers offer no device");
    }
    if (auto failure = check(result, "list the Vulkan devices")) return *failure;
    return devices;
}

VkPhysicalDeviceProperties properties_of(VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device, &properties);
    return properties;
}

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool name_contains(VkPhysicalDevice device, const std::string& part) {
    return lower_case(properties_of(device).deviceName).find(lower_case(part)) != std::string::npos;
}

std::vector<std::string> names_of(const std::vector<VkPhysicalDevice>& devices) {
    std::vector<std::string> names;
    for (VkPhysicalDevice device : devices) names.emplace_back(properties_of(device).deviceName);
    return names;
}

Result<VkPhysicalDevice> choose(const std::vector<VkPhysicalDevice>& devices,
                                const std::string& wanted) {
    const auto first = [&](const auto& accepts) {
        const auto found = std::find_if(devices.begin(), devices.end(), accepts);
        return found == devices.end() ? VkPhysicalDevice{} : *found;
    };
    if (!wanted.empty()) {
        VkPhysicalDevice named =
            first([&](VkPhysicalDevice d) { return name_contains(d, wanted); });
        if (named) return named;
        return input_error("unknown-device",
                           fmt::format("no Vulkan device has '{}' in its name; there is: {}",
                                       wanted, fmt::join(names_of(devices), ", ")));
    }
    VkPhysicalDevice chosen =
        first([](VkPhysicalDevice d) { return name_contains(d, "llvmpipe"); });
    if (!chosen) {
        chosen = first([](VkPhysicalDevice d) {
            return properties_of(d).deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
        });
    }
    return chosen ? chosen : devices.front();
}

// RADV offers the chip that this variable names, in place of what is there, when devices are
// listed.
class ForcedFamily {
  public:
    explicit ForcedFamily(const std::string& chip) : forced_(!chip.empty()) {
        if (!forced_) return;
        if (const char* before = std::getenv(variable)) before_ = before;
        setenv(variable, chip.c_str(), 1);
    }
    ForcedFamily(const ForcedFamily&) = delete;
    ForcedFamily& operator=(const ForcedFamily&) = delete;
    ~ForcedFamily() {
        if (!forced_) return;
        if (before_)
            setenv(variable, before_->c_str(), 1);
        else
            unsetenv(variable);
    }

  private:
    static constexpr const char* variable = "RADV_FORCE_FAMILY";
    bool forced_;
    std::optional<std::string> before_;
};

Result<VkPhysicalDevice> choose_chip(const std::vector<VkPhysicalDevice>& devices,
                                     const std::string& chip) {
    for (VkPhysicalDevice device : devices)
        if (name_contains(device, "radv")) return device;
    Diagnostic error =
        input_error("unknown-chip", fmt::format("no driver here compiles for {}; there is: {}",
                                                chip, fmt::join(names_of(devices), ", ")));
    error.notes.emplace_back("hint: install Mesa's RADV (Debian's mesa-vulkan-drivers)");
    return error;
}

std::string driver_of(VkPhysicalDevice physical, const VkPhysicalDeviceProperties& properties) {
    if (properties.apiVersion < VK_API_VERSION_1_2)
        return fmt::format("driver version {:#x}", properties.driverVersion);
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceProperties2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    all.pNext = &driver;
    vkGetPhysicalDeviceProperties2(physical, &all);
    return fmt::format("{} {}", driver.driverName, driver.driverInfo);
}

Failure choose_queue_family(DeviceState& state) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(state.physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(state.physical, &count, families.data());
    for (std::uint32_t i = 0; i < count; ++i) {
        if (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) {
            state.queue_family = i;
            state.timestamp_bits = families[i].timestampValidBits;
            return {};
        }
    }
    return no_vulkan_device(
        fmt::format("the Vulkan device {} cannot draw", state.properties.deviceName));
}

bool has_extension(VkPhysicalDevice device, const char* name) {
    std::uint32_t count = 0;
    if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS)
        return false;
    std::vector<VkExtensionProperties> extensions(count);
    if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()) !=
        VK_SUCCESS)
        return false;
    return std::any_of(extensions.begin(), extensions.end(), [&](const auto& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

// `only_compiles`: a chip that is not there, which has no fences and takes no commands.
Failure open_device(DeviceState& state, bool only_compiles) {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = state.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceFeatures available{}, wanted{};
    vkGetPhysicalDeviceFeatures(state.physical, &available);
    wanted.independentBlend = available.independentBlend;
    state.independent_blend = available.independentBlend == VK_TRUE;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.pEnabledFeatures = &wanted;
    const char* const executables = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR tell{};
    tell.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
    tell.pipelineExecutableInfo = VK_TRUE;
    state.tells_statistics = only_compiles && has_extension(state.physical, executables);
    if (state.tells_statistics) {
        info.pNext = &tell;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &executables;
    }
    if (auto failure = check(vkCreateDevice(state.physical, &info, nullptr, &state.device),
                             "open the Vulkan device")) {
        return failure;
    }
    if (only_compiles) return {};
    vkGetDeviceQueue(state.device, state.queue_family, 0, &state.queue);

    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.queueFamilyIndex = state.queue_family;
    if (auto failure = check(vkCreateCommandPool(state.device, &pool, nullptr, &state.pool),
                             "create a command pool")) {
        return failure;
    }
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    return check(vkCreateFence(state.device, &fence, nullptr, &state.fence), "create a fence");
}

}  // namespace

Failure check(VkResult result, const char* what) {
    switch (result) {
        case VK_SUCCESS: return {};
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return input_error("out-of-memory",
                               fmt::format("cannot {}: the host is out of memory", what));
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return input_error("out-of-memory",
                               fmt::format("cannot {}: the Vulkan device is out of memory", what));
        case VK_ERROR_DEVICE_LOST:
            return input_error("device-lost",
                               fmt::format("cannot {}: the Vulkan device was lost, which a driver "
                                           "does to a shader that runs too long or faults",
                                           what));
        default:
            return internal_error("vulkan-error",
                                  fmt::format("cannot {}: Vulkan answers with result {}", what,
                                              static_cast<int>(result)));
    }
}

InstanceState::~InstanceState() {
    if (messenger != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
        if (destroy) destroy(instance, messenger, nullptr);
    }
    if (instance != VK_NULL_HANDLE) vkDestroyInstance(instance, nullptr);
}

DeviceState::~DeviceState() {
    if (device == VK_NULL_HANDLE) return;
    vkDestroyFence(device, fence, nullptr);
    vkDestroyCommandPool(device, pool, nullptr);
    vkDestroyDevice(device, nullptr);
}

std::span<const std::string_view> chips() { return known_chips; }

Result<Device> Device::create(const DeviceOptions& options) {
    const std::vector<std::string> known(std::begin(known_chips), std::end(known_chips));
    if (!options.chip.empty() && std::find(known.begin(), known.end(), options.chip) == known.end())
        return input_error("unknown-chip", unknown_name_sentence("chip", options.chip, known));
    const ForcedFamily forced(options.chip);
    auto instance = make_instance(options.validation);
    if (!instance) return instance.error();
    auto devices = physical_devices((*instance)->instance);
    if (!devices) return devices.error();
    keep_loaded(options.validation);
    auto chosen = options.chip.empty() ? choose(*devices, options.device)
                                       : choose_chip(*devices, options.chip);
    if (!chosen) return chosen.error();

    auto state = std::make_shared<DeviceState>();
    state->instance = std::move(*instance);
    state->physical = *chosen;
    state->properties = properties_of(*chosen);
    vkGetPhysicalDeviceMemoryProperties(*chosen, &state->memory);
    if (state->properties.apiVersion < VK_API_VERSION_1_1) {
        return no_vulkan_device(fmt::format("the Vulkan device {} is older than Vulkan 1.1",
                                            state->properties.deviceName));
    }
    state->driver = driver_of(*chosen, state->properties);
    if (auto failure = choose_queue_family(*state)) return *failure;
    if (auto failure = open_device(*state, !options.chip.empty())) return *failure;
    return Device(std::move(state));
}

Result<std::vector<std::string>> Device::list() {
    auto instance = make_instance(false);
    if (!instance) return instance.error();
    auto devices = physical_devices((*instance)->instance);
    if (!devices) return devices.error();
    keep_loaded(false);
    return names_of(*devices);
}

std::string Device::name() const { return state_->properties.deviceName; }

std::string Device::driver() const { return state_->driver; }

bool Device::is_cpu() const { return state_->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }

double Device::timestamp_period() const {
    return state_->timestamp_bits == 0
               ? 0.0
               : static_cast<double>(state_->properties.limits.timestampPeriod);
}

std::vector<std::string> Device::validation_messages() const {
    MessageLog& log = *state_->instance->log;
    const std::lock_guard lock(log.mutex);
    return log.messages;
}

}  // namespace intaglio::vulkan
