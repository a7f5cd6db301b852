// What the interpreter's tests share: a shader from its text, and one run of it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/interpret.h"

namespace intaglio::d3d9 {

inline Shader parsed(const std::string& text) {
    Result<Shader> shader = parse(text, "test.asm", Profile::ps_2_a);
    if (!shader) {
        ADD_FAILURE() << to_string(shader.error()) << "\n" << text;
        return {};
    }
    return *shader;
}

inline Interpreter prepared(const Shader& shader) {
    Result<Interpreter> interpreter = Interpreter::prepare(shader);
    if (!interpreter) throw std::runtime_error(to_string(interpreter.error()));
    return *interpreter;
}

inline Execution ran(const std::string& text, const Environment& environment = {},
                     const Inputs& inputs = {}, Arithmetic arithmetic = Arithmetic::Fp32) {
    return prepared(parsed(text)).run(environment, inputs, arithmetic);
}

// The code with r0 = c0, r1 = c1, r2 = c2, r3 = c3 before it; what it leaves in r0.
inline Vector r0_after(const std::string& code, const std::vector<Vector>& constants,
                       Arithmetic arithmetic = Arithmetic::Fp32,
                       const std::string& profile = "ps_3_0") {
    Environment environment;
    environment.constants = constants;
    return ran(profile + "\nmov r0, c0\nmov r1, c1\nmov r2, c2\nmov r3, c3\n" + code +
                   "\nmov oC0, r0\n",
               environment, {}, arithmetic)
        .colours[0];
}

// Equal in every lane; NaN equals NaN.
MATCHER_P(SameNumbers, expected, "") {
    for (std::size_t i = 0; i < 4; ++i) {
        const float a = arg[i], b = expected[i];
        if (a != b && !(a != a && b != b)) {
            *result_listener << "lane " << i << ": " << a << " instead of " << b;
            return false;
        }
    }
    return true;
}

}  // namespace intaglio::d3d9
