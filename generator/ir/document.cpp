// Markdown from the ops table.
#include "generator/ir/document.h"

#include <fmt/format.h>

#include "generator/ir/ops.h"

namespace intaglio::ir {
namespace {

// What an op of this rule takes and gives, as a reader of the text needs it; n stands for one
// width.
std::string_view signature(Op op) {
    switch (op) {
        case Op::Constant: return "-> any type";
        case Op::Input: return "input -> its type";
        case Op::Uniform: return "uniform[element] -> its type";
        case Op::SampleLevel: return "sampler, float2 or float3, float1 -> float4";
        case Op::SampleGrad: return "sampler, three of float2 or float3 -> float4";
        case Op::SampleImplicit: return "sampler, float2 or float3 -> float4";
        case Op::Return: return "one value for each output";
        case Op::Yield: return "the values the region gives";
        default: break;
    }
    switch (info(op).type_rule) {
        case TypeRule::SameNumeric: return "float*n* or int*n* -> the same";
        case TypeRule::SameFloat: return "float*n* -> the same";
        case TypeRule::Dot: return "float*n* -> float1";
        case TypeRule::Cross: return "float3 -> float3";
        case TypeRule::Compare: return "float1 or int1 -> bool1";
        case TypeRule::Logic: return "bool1 -> bool1";
        case TypeRule::Select: return "bool1, two of any type -> that type";
        case TypeRule::ToFloat: return "int*n* -> float*n*";
        case TypeRule::Compose: return "2 to 4 of one kind, at most 4 components -> their sum";
        case TypeRule::Swizzle: return "any type.letters -> as many components";
        case TypeRule::Loop: return "carried values -> the same types";
        case TypeRule::If: return "bool1 -> what its regions yield";
        case TypeRule::BreakIf: return "bool1, carried values";
        default: return "";
    }
}

// What a table cell must not hold as it is.
std::string escaped(std::string_view text) {
    std::string result;
    for (char c : text) {
        if (c == '|' || c == '*') result += '\\';
        result += c;
    }
    return result;
}

}  // namespace

std::string ops_table_markdown() {
    std::string text =
        "| op | operands | types | same bits on every device | semantics "
        "|\n|---|---|---|---|---|\n";
    for (const OpInfo& row : all_ops()) {
        const std::string count =
            row.operand_count == any_count ? "any" : fmt::format("{}", row.operand_count);
        text += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.name, count, signature(row.op),
                            row.bit_exact ? "yes" : "no", escaped(row.semantics));
    }
    return text;
}

}  // namespace intaglio::ir
