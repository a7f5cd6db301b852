// Direct3D 9 shaders as bytecode, from their assembly.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"

namespace intaglio::d3d9 {

inline Shader assembled(const std::string& text, std::vector<Constant> constants = {}) {
    Result<Shader> shader = parse(text, "test.asm");
    if (!shader) {
        ADD_FAILURE() << to_string(shader.error()) << "\n" << text;
        return {};
    }
    shader->constants = std::move(constants);
    return *shader;
}

}  // namespace intaglio::d3d9
