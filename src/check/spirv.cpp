// SPIRV-Tools: its messages become Diagnostics; nothing of its API leaves this file.
#include "src/check/spirv.h"

#include <fmt/format.h>

#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

namespace intaglio::check {
namespace {

constexpr spv_target_env target = SPV_ENV_VULKAN_1_1;

// Keeps the first error of a tool; "sentence\n  %5 = OpFoo ..." is split at the line break.
struct FirstError {
    std::string message;
    std::string instruction;
    std::size_t index = 0;

    spvtools::MessageConsumer consumer() {
        return [this](spv_message_level_t level, const char*, const spv_position_t& position,
                      const char* text) {
            if (level > SPV_MSG_ERROR || !message.empty()) return;
            const std::string_view all(text);
            const std::size_t line_break = all.find('\n');
            message = all.substr(0, line_break);
            if (line_break != std::string_view::npos) instruction = all.substr(line_break + 1);
            index = position.index;
        };
    }

    Diagnostic diagnostic(std::string code, std::string_view tool,
                          std::string_view otherwise) const {
        Diagnostic error = input_error(
            std::move(code), fmt::format("{}: {}", tool, message.empty() ? otherwise : message));
        const std::size_t first = instruction.find_first_not_of(" \n");
        const std::size_t last = instruction.find_last_not_of(" \n");
        if (first != std::string::npos) {
            error.notes.push_back(
                fmt::format("at word {}: {}", index, instruction.substr(first, last - first + 1)));
        }
        return error;
    }
};

}  // namespace

Status validate_spirv(const SpirvWords& words) {
    FirstError first;
    spvtools::SpirvTools tools(target);
    tools.SetMessageConsumer(first.consumer());
    if (tools.Validate(words)) return Done{};
    return first.diagnostic("spirv-invalid", "spirv-val", "the module is not valid");
}

Result<SpirvWords> optimize_spirv(const SpirvWords& words) {
    // The optimiser trusts its input, so the validator goes first.
    if (Status valid = validate_spirv(words); !valid) return valid.error();
    FirstError first;
    spvtools::Optimizer optimizer(target);
    optimizer.SetMessageConsumer(first.consumer());
    optimizer.RegisterPerformancePasses();
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);
    SpirvWords optimized;
    if (!optimizer.Run(words.data(), words.size(), &optimized, options)) {
        return first.diagnostic("spirv-opt-failed", "spirv-opt", "a pass failed");
    }
    if (Status valid = validate_spirv(optimized); !valid) return valid.error();
    return optimized;
}

Result<std::string> disassemble(const SpirvWords& words) {
    FirstError first;
    spvtools::SpirvTools tools(target);
    tools.SetMessageConsumer(first.consumer());
    std::string text;
    if (tools.Disassemble(words, &text)) return text;
    return first.diagnostic("spirv-unreadable", "spirv-dis", "the module cannot be read");
}

}  // namespace intaglio::check
