// How much of everything a Direct3D 9 shader may use, one row per profile.  The numbers were probed
// on Direct3D's own validator; where that one is laxer than the documentation or the hardware, a
// second table has its view.
#pragma once

#include <string_view>

#include "generator/target/d3d9/ops.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

inline constexpr int no_limit = 1 << 20;

struct Limits {
    std::string_view name;  // as messages call it
    Profile profile;        // whose instructions and operand rules apply

    // Slots, by the validator's charge.
    int arithmetic_slots, texture_slots, total_slots;

    // Registers of each file, numbered from 0.
    int temps, constants, integers, booleans, samplers, inputs, texcoords, colour_outputs, outputs;

    int dependent_level;    // highest order of a texture read
    int constant_operands;  // how many operands may name the one c# of an instruction

    // Depth of nesting: if on a b#, if on a computed value, rep and loop, call.  And in all:
    // vs_2_0's flow count.
    int static_depth, dynamic_depth, loop_depth, call_depth, static_flow;

    bool arbitrary_swizzle;  // else identity, one component, yzxw, zxyw, wzyx
    bool initialised_lanes;  // reading what no path has written is refused
    // What Direct3D lets pass, though nothing good comes of it: a shader that writes no output, the
    // w of a nrm.
    bool strict;
    bool all_capabilities;  // ps_2_x with every optional capability: static and dynamic flow

    bool model_3() const { return profile == Profile::ps_3_0 || profile == Profile::vs_3_0; }
    bool pixel() const { return is_pixel(profile); }
    bool has(const OpInfo& op) const;
};

// What a shader of the profile must keep to.
const Limits& limits_of(Profile profile);

// What Direct3D's validator refuses.  It knows only ps_2_x with every capability, leaves
// initialisation to ps_2_0, and leaves what depends on the device (slots of model 3, constants of
// vertex shaders) to the device.
const Limits& validator_limits(Profile profile);

}  // namespace intaglio::d3d9
