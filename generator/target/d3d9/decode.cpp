// Reads a token stream strictly: every bit is either understood or refused.
#include <algorithm>

#include <fmt/format.h>

#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/constant_table.h"
#include "generator/target/d3d9/ops.h"
#include "generator/target/d3d9/tokens.h"

namespace intaglio::d3d9 {
namespace {

class Decoder {
  public:
    Decoder(std::span<const std::uint32_t> stream, std::optional<Profile> x_profile)
        : stream_(stream), x_profile_(x_profile) {}

    Result<Shader> decode() {
        if (auto status = read_version(); !status) return status.error();
        for (at_ = 1; at_ < stream_.size();) {
            begin_ = at_;
            const std::uint32_t token = stream_[at_++];
            if (token == tokens::end) {
                if (at_ != stream_.size())
                    return error(at_,
                                 fmt::format("{} tokens follow the end", stream_.size() - at_));
                return std::move(shader_);
            }
            if (auto status = read_one(token); !status) return status.error();
        }
        return error(stream_.size(), "the stream stops without an end token");
    }

  private:
    static Diagnostic error(std::size_t offset, std::string message) {
        return input_error("d3d9-bytecode", fmt::format("at token {}, {}", offset, message));
    }

    Status read_version() {
        if (stream_.empty()) return error(0, "the stream is empty");
        const auto* found =
            std::find(std::begin(tokens::versions), std::end(tokens::versions), stream_[0]);
        if (found == std::end(tokens::versions))
            return error(
                0, fmt::format(
                       "0x{:08x} is not the version of ps_2_0, ps_2_x, ps_3_0, vs_2_0 or vs_3_0",
                       stream_[0]));
        shader_.profile = static_cast<Profile>(found - std::begin(tokens::versions));
        if (shader_.profile == Profile::ps_2_a && x_profile_ == Profile::ps_2_b)
            shader_.profile = Profile::ps_2_b;
        return Done{};
    }

    // One comment, declaration, definition or instruction, whose first token was taken.
    Status read_one(std::uint32_t token) {
        const std::uint32_t opcode = token & tokens::opcode_mask;
        const bool is_comment = opcode == tokens::comment && token >> 31 == 0;
        if (!is_comment && (token & tokens::instruction_reserved) != 0)
            return error(
                begin_,
                fmt::format("0x{:08x} has a bit set that no instruction of this version has",
                            token));
        const std::size_t length =
            is_comment ? token >> tokens::comment_length_shift & tokens::comment_length_mask
                       : token >> tokens::length_shift & tokens::length_mask;
        if (length > stream_.size() - at_)
            return error(begin_, fmt::format("the length is {} but only {} tokens are left", length,
                                             stream_.size() - at_));
        limit_ = at_ + length;
        auto status = is_comment               ? read_comment()
                      : opcode == tokens::dcl  ? read_declaration(token)
                      : opcode == tokens::def  ? read_definition(token, File::Const)
                      : opcode == tokens::defi ? read_definition(token, File::ConstInt)
                      : opcode == tokens::defb ? read_definition(token, File::ConstBool)
                                               : read_instruction(token);
        if (!status) return status;
        if (at_ != limit_)
            return error(begin_, fmt::format("the length is {} where the operands take {}", length,
                                             at_ - begin_ - 1));
        return Done{};
    }

    Status read_comment() {
        const auto words = stream_.subspan(at_, limit_ - at_);
        at_ = limit_;
        if (words.empty() || words[0] != constant_table_tag || has_table_) return Done{};
        auto table = parse_constant_table(words.subspan(1));
        if (!table) return error(begin_, table.error().message);
        has_table_ = true;
        shader_.constants = std::move(table->constants);
        const auto named = profile_named(table->target);
        if (named == Profile::ps_2_b && shader_.profile == Profile::ps_2_a && !x_profile_)
            shader_.profile = Profile::ps_2_b;
        return Done{};
    }

    Result<std::uint32_t> next() {
        if (at_ >= limit_) return error(begin_, "the length leaves out an operand");
        return stream_[at_++];
    }

    // The operand token, its reserved bits checked.
    Result<std::uint32_t> next_parameter() {
        const auto token = next();
        if (token && (*token & tokens::parameter) == 0)
            return error(at_ - 1,
                         fmt::format("0x{:08x} is no operand: its highest bit is clear", *token));
        if (token && (*token & tokens::parameter_reserved) != 0)
            return error(at_ - 1,
                         fmt::format("0x{:08x} has a bit set that no operand has", *token));
        return token;
    }

    Result<File> file_of(std::uint32_t token) const {
        const auto file =
            file_of_type(shader_.profile, tokens::type_of(token), token & tokens::number_mask);
        if (file) return *file;
        return error(at_ - 1, fmt::format("{} has no register of type {} and number {}",
                                          version_of(shader_.profile), tokens::type_of(token),
                                          token & tokens::number_mask));
    }

    int number_of(File file, std::uint32_t token) const {
        return info(file).numbered ? static_cast<int>(token & tokens::number_mask) : 0;
    }

    static Swizzle swizzle_of(std::uint32_t token) {
        Swizzle swizzle{};
        for (std::uint32_t lane = 0; lane < 4; ++lane)
            swizzle[lane] =
                static_cast<std::uint8_t>(token >> (tokens::swizzle_shift + 2 * lane) & 3);
        return swizzle;
    }

    // The register that is added to the one of this token, if bit 13 says so.
    Result<std::optional<Relative>> read_relative(std::uint32_t token) {
        if ((token & tokens::relative) == 0) return std::optional<Relative>();
        const auto added = next_parameter();
        if (!added) return added.error();
        const auto file = file_of(*added);
        if (!file) return file.error();
        const Swizzle swizzle = swizzle_of(*added);
        const bool counter = *file == File::LoopCounter && swizzle == identity_swizzle;
        const bool address = *file == File::Address && swizzle == replicate(swizzle[0]);
        const bool plain = (*added & (tokens::number_mask | tokens::relative |
                                      tokens::modifier_mask << tokens::modifier_shift)) == 0;
        if (!(counter || address) || !plain)
            return error(at_ - 1,
                         "only aL or one component of a0 can be added to a register number");
        return std::optional(Relative{*file, address ? swizzle[0] : 0});
    }

    Result<Destination> read_destination() {
        const auto token = next_parameter();
        if (!token) return token.error();
        if ((*token & tokens::destination_reserved) != 0)
            return error(
                at_ - 1,
                fmt::format(
                    "0x{:08x} has a result shift or modifier that this version does not know",
                    *token));
        const auto file = file_of(*token);
        if (!file) return file.error();
        Destination result;
        result.file = *file;
        result.index = number_of(*file, *token);
        result.mask = static_cast<Mask>(*token >> tokens::mask_shift & full_mask);
        result.saturate = (*token & tokens::saturate) != 0;
        result.partial_precision = (*token & tokens::partial_precision) != 0;
        result.centroid = (*token & tokens::centroid) != 0;
        if (result.mask == 0) return error(at_ - 1, "the destination has an empty write mask");
        auto relative = read_relative(*token);
        if (!relative) return relative.error();
        if (*relative && !info(*file).numbered)
            return error(at_ - 2, "a register without a number is addressed relatively");
        result.relative = *relative;
        return result;
    }

    Result<Source> read_source() {
        const auto token = next_parameter();
        if (!token) return token.error();
        const auto file = file_of(*token);
        if (!file) return file.error();
        const auto* modifier = std::find(tokens::modifiers.begin(), tokens::modifiers.end(),
                                         *token >> tokens::modifier_shift & tokens::modifier_mask);
        if (modifier == tokens::modifiers.end())
            return error(
                at_ - 1,
                fmt::format("0x{:08x} has a source modifier that this version does not know",
                            *token));
        Source result;
        result.file = *file;
        result.index = number_of(*file, *token);
        result.swizzle = swizzle_of(*token);
        result.modifier = static_cast<Modifier>(modifier - tokens::modifiers.begin());
        auto relative = read_relative(*token);
        if (!relative) return relative.error();
        if (*relative && !info(*file).numbered)
            return error(at_ - 2, "a register without a number is addressed relatively");
        result.relative = *relative;
        return result;
    }

    // Declarations and definitions have no control bits and come first.
    Status check_preamble(std::uint32_t token) const {
        if ((token & (tokens::control_mask << tokens::control_shift | tokens::predicated)) != 0)
            return error(begin_, "a declaration or definition has control bits or a predicate");
        if (!shader_.instructions.empty())
            return error(begin_, "a declaration or definition follows an instruction");
        return Done{};
    }

    Status read_declaration(std::uint32_t token) {
        if (auto status = check_preamble(token); !status) return status;
        const auto what = next();
        if (!what) return what.error();
        if ((*what & tokens::parameter) == 0 || (*what & tokens::declaration_reserved) != 0)
            return error(at_ - 1, fmt::format("0x{:08x} does not say what is declared", *what));
        auto target = read_destination();
        if (!target) return target.error();
        Declaration declaration;
        declaration.target = *target;
        if (!can_declare(target->file) || target->relative)
            return error(at_ - 1, "this register cannot be declared");
        const std::uint32_t usage = *what & tokens::usage_mask,
                            kind = *what >> tokens::kind_shift & tokens::kind_mask;
        if (usage > static_cast<std::uint32_t>(Usage::Sample))
            return error(begin_ + 1, fmt::format("there is no usage {}", usage));
        if (has_usage(shader_.profile, target->file)) {
            declaration.usage = static_cast<Usage>(usage);
            declaration.usage_index =
                static_cast<int>(*what >> tokens::usage_index_shift & tokens::usage_index_mask);
        }
        const bool kind_known =
            kind == 0 || (kind >= 2 && kind <= 4 && target->file == File::Sampler);
        if (!kind_known)
            return error(begin_ + 1,
                         fmt::format("there is no texture kind {} for this register", kind));
        if (kind != 0) declaration.sampler = static_cast<SamplerKind>(kind - 1);
        shader_.declarations.push_back(declaration);
        return Done{};
    }

    Status read_definition(std::uint32_t token, File file) {
        if (auto status = check_preamble(token); !status) return status;
        auto target = read_destination();
        if (!target) return target.error();
        Definition definition;
        definition.file = file;
        definition.index = target->index;
        Destination plain;
        plain.file = file;
        plain.index = target->index;
        if (*target != plain)
            return error(begin_ + 1,
                         fmt::format("a whole {} register is to be defined", info(file).name));
        const std::size_t count = file == File::ConstBool ? 1 : 4;
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = next();
            if (!value) return value.error();
            definition.bits[i] = file == File::ConstBool ? *value != 0 : *value;
        }
        shader_.definitions.push_back(definition);
        return Done{};
    }

    Status read_instruction(std::uint32_t token) {
        const std::uint32_t opcode = token & tokens::opcode_mask;
        const std::uint32_t control = token >> tokens::control_shift & tokens::control_mask;
        const OpInfo* row = op_of_token(opcode, control);
        if (!row)
            return error(begin_, fmt::format("there is no instruction {} with control bits {}",
                                             opcode, control));
        Instruction instruction;
        instruction.op = row->op;
        if (row->has(Trait::Compares)) {
            if (control < 1 || control > static_cast<std::uint32_t>(Comparison::LessEqual))
                return error(begin_, fmt::format("there is no comparison {}", control));
            instruction.comparison = static_cast<Comparison>(control);
        }
        if (row->has_destination()) {
            auto destination = read_destination();
            if (!destination) return destination.error();
            instruction.destination = *destination;
        }
        if ((token & tokens::predicated) != 0) {
            auto predicate = read_source();
            if (!predicate) return predicate.error();
            if (predicate->file != File::Predicate || predicate->relative)
                return error(at_ - 1, "an instruction is predicated by another register than p0");
            instruction.predicate = *predicate;
        }
        for (int i = source_count(row->op, shader_.profile); i > 0; --i) {
            auto source = read_source();
            if (!source) return source.error();
            instruction.sources.push_back(*source);
        }
        shader_.instructions.push_back(std::move(instruction));
        return Done{};
    }

    std::span<const std::uint32_t> stream_;
    std::optional<Profile> x_profile_;
    std::size_t at_ = 0;     // the next token
    std::size_t begin_ = 0;  // the first token of what is being read
    std::size_t limit_ = 0;  // the token after it, as its length says
    bool has_table_ = false;
    Shader shader_;
};

}  // namespace

Result<Shader> decode(std::span<const std::uint32_t> stream, std::optional<Profile> x_profile) {
    return Decoder(stream, x_profile).decode();
}

std::vector<std::uint32_t> without_comments(std::span<const std::uint32_t> stream) {
    std::vector<std::uint32_t> result(stream.begin(), stream.begin() + (stream.empty() ? 0 : 1));
    for (std::size_t at = 1; at < stream.size();) {
        const std::uint32_t token = stream[at];
        const bool is_comment = (token & 0x8000FFFF) == tokens::comment;
        const std::size_t length =
            token == tokens::end ? 0
            : is_comment ? token >> tokens::comment_length_shift & tokens::comment_length_mask
                         : token >> tokens::length_shift & tokens::length_mask;
        const std::size_t next = std::min(stream.size(), at + 1 + length);
        if (!is_comment)
            result.insert(result.end(), stream.begin() + static_cast<std::ptrdiff_t>(at),
                          stream.begin() + static_cast<std::ptrdiff_t>(next));
        at = next;
    }
    return result;
}

}  // namespace intaglio::d3d9
