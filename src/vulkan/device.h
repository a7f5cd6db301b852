// A Vulkan device without a window.  lavapipe (Mesa's CPU driver) is the default, so that every
// machine draws the same bits; any other device by name.  Life of a run: create a Device, prepare
// Programs on it (program.h), draw them. Copies share the device; the last copy or Program to go
// destroys it.  Use it from one thread at a time.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::vulkan {

struct DeviceOptions {
    // Part of the device's name, in any case.  Empty: llvmpipe, else any CPU device, else the first
    // device.
    std::string device = {};
    // Turns on VK_LAYER_KHRONOS_validation with synchronization validation; see
    // Device::validation_messages.
    bool validation = false;
    // A chip of AMD's that need not be there, one of chips(), for the compiler of Mesa's RADV.  The
    // device compiles (compiled.h) and cannot draw.  It is asked for in the process's environment,
    // so no other thread may read that meanwhile.
    std::string chip = {};
};

// What DeviceOptions::chip may be: from Southern Islands (tahiti, 2012) to RDNA 2 (vangogh, 2022).
std::span<const std::string_view> chips();

struct DeviceState;  // the Vulkan objects; device_state.h

class Device {
  public:
    // Errors: `no-vulkan-device` (no loader, driver or device), `unknown-device` (lists those there
    // are), `unknown-chip`, `no-validation-layer`, and those of any Vulkan call: `out-of-memory`,
    // `device-lost`, `vulkan-error`.
    static Result<Device> create(const DeviceOptions& options = {});
    // Names of all devices that the installed drivers offer, in the loader's order.  Errors as for
    // create.
    static Result<std::vector<std::string>> list();

    std::string name() const;
    std::string driver() const;  // name and version as the driver words them
    bool is_cpu() const;         // drawn by the CPU: its times mean something only as ratios
    double timestamp_period()
        const;  // nanoseconds per timestamp step; 0: the device has no timestamps
    // Errors and warnings of the validation layer so far; empty without DeviceOptions::validation.
    std::vector<std::string> validation_messages() const;

    const std::shared_ptr<DeviceState>& state() const { return state_; }

  private:
    explicit Device(std::shared_ptr<DeviceState> state) : state_(std::move(state)) {}
    std::shared_ptr<DeviceState> state_;
};

}  // namespace intaglio::vulkan
