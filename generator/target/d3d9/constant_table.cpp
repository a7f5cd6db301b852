// The table is bytes with offsets from its start, in little-endian words.
#include "generator/target/d3d9/constant_table.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace intaglio::d3d9 {
namespace {

constexpr std::size_t header_size = 28, constant_size = 20, type_size = 16;
constexpr std::string_view creator = "Intaglio";

enum Class : std::uint32_t {
    Scalar = 0,
    Vector = 1,
    MatrixRows = 2,
    MatrixColumns = 3,
    Object = 4,
    Structure = 5
};
enum Type : std::uint32_t {
    Bool = 1,
    Int = 2,
    Float = 3,
    SamplerAny = 10,
    Sampler2D = 12,
    Sampler3D = 13,
    SamplerCube = 14
};

bool comes_before(const Constant& a, const Constant& b) {
    if (a.set != b.set) return a.set < b.set;
    return a.index != b.index ? a.index < b.index : a.name < b.name;
}

bool is_name(std::string_view name) {
    const auto allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '$' || c == '.';
    };
    return !name.empty() && std::all_of(name.begin(), name.end(), allowed);
}

class Bytes {
  public:
    void word(std::uint32_t value) {
        half(value & 0xFFFF);
        half(value >> 16);
    }
    void half(std::uint32_t value) {
        bytes_.push_back(static_cast<std::uint8_t>(value));
        bytes_.push_back(static_cast<std::uint8_t>(value >> 8));
    }
    // Where the string begins.
    std::uint32_t string(std::string_view text) {
        const std::uint32_t begin = size();
        bytes_.insert(bytes_.end(), text.begin(), text.end());
        bytes_.push_back(0);
        return begin;
    }
    void align() {
        while (bytes_.size() % 4 != 0) bytes_.push_back(0xAB);  // as Microsoft's compiler pads
    }
    void resize(std::size_t size) { bytes_.resize(size); }
    void set_word(std::size_t at, std::uint32_t value) {
        for (std::size_t i = 0; i < 4; ++i)
            bytes_[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
    }
    std::uint32_t size() const { return static_cast<std::uint32_t>(bytes_.size()); }

    std::vector<std::uint32_t> words() const {
        std::vector<std::uint32_t> result(bytes_.size() / 4);
        for (std::size_t i = 0; i < bytes_.size(); ++i)
            result[i / 4] |= static_cast<std::uint32_t>(bytes_[i]) << (8 * (i % 4));
        return result;
    }

  private:
    std::vector<std::uint8_t> bytes_;
};

std::uint32_t sampler_type(const Shader& shader, int index) {
    for (const Declaration& declaration : shader.declarations) {
        if (declaration.target.file != File::Sampler || declaration.target.index != index) continue;
        switch (declaration.sampler) {
            case SamplerKind::Texture2D: return Sampler2D;
            case SamplerKind::Volume: return Sampler3D;
            case SamplerKind::Cube: return SamplerCube;
            case SamplerKind::None: return SamplerAny;
        }
    }
    return SamplerAny;
}

void write_type(Bytes& bytes, const Constant& constant, const Shader& shader) {
    const bool sampler = constant.set == Constant::Set::Sampler;
    const bool matrix = constant.rows != 1;
    const std::uint32_t type = sampler ? sampler_type(shader, constant.index)
                               : constant.set == Constant::Set::Bool ? std::uint32_t{Bool}
                               : constant.set == Constant::Set::Int4 ? std::uint32_t{Int}
                                                                     : std::uint32_t{Float};
    bytes.half(sampler ? Object : matrix ? MatrixColumns : constant.columns > 1 ? Vector : Scalar);
    bytes.half(type);
    bytes.half(static_cast<std::uint32_t>(constant.rows));
    bytes.half(static_cast<std::uint32_t>(sampler ? 1 : constant.columns));
    bytes.half(static_cast<std::uint32_t>(constant.elements));
    bytes.half(0);
    bytes.word(0);
}

// Reads within bounds; anything outside is nothing.
class Reader {
  public:
    explicit Reader(std::span<const std::uint32_t> words) : words_(words) {}

    std::size_t size() const { return words_.size() * 4; }
    std::uint32_t byte(std::size_t at) const { return words_[at / 4] >> (8 * (at % 4)) & 0xFF; }
    std::uint32_t half(std::size_t at) const { return byte(at) | byte(at + 1) << 8; }
    std::uint32_t word(std::size_t at) const { return half(at) | half(at + 2) << 16; }
    bool has(std::size_t at, std::size_t count) const {
        return at <= size() && count <= size() - at;
    }

    std::optional<std::string> string(std::size_t at) const {
        std::string text;
        for (; at < size(); ++at) {
            if (byte(at) == 0) return text;
            text += static_cast<char>(byte(at));
        }
        return std::nullopt;
    }

  private:
    std::span<const std::uint32_t> words_;
};

Diagnostic error(std::string message) {
    return input_error("d3d9-bytecode", "in the constant table, " + std::move(message));
}

Status read_shape(const Reader& reader, std::size_t at, Constant& constant) {
    if (!reader.has(at, type_size))
        return error(fmt::format("the type of {} lies outside", constant.name));
    const std::uint32_t type_class = reader.half(at);
    constant.rows = static_cast<int>(reader.half(at + 4));
    constant.columns = static_cast<int>(reader.half(at + 6));
    constant.elements = static_cast<int>(reader.half(at + 8));
    if (constant.set == Constant::Set::Sampler) {
        constant.rows = 1;
        constant.columns = 0;
    } else if (type_class == Structure || type_class == Object) {
        constant.rows = 1;
        constant.columns = 4;
        constant.elements = constant.count;
    } else if (type_class == MatrixRows) {
        std::swap(constant.rows, constant.columns);
    } else if (type_class > Structure) {
        return error(fmt::format("{} has the unknown class {}", constant.name, type_class));
    }
    const bool sampler = constant.set == Constant::Set::Sampler;
    const bool shaped = constant.rows >= 1 && constant.rows <= 4 && constant.columns <= 4 &&
                        (sampler || constant.columns >= 1);
    if (!shaped)
        return error(fmt::format("{} has a type of {} by {}", constant.name, constant.rows,
                                 constant.columns));
    if (constant.elements < 1) return error(fmt::format("{} has no elements", constant.name));
    return Done{};
}

Result<Constant> read_constant(const Reader& reader, std::size_t at) {
    Constant constant;
    const auto name = reader.string(reader.word(at));
    if (!name || !is_name(*name))
        return error(fmt::format("the entry at byte {} has no proper name", at));
    constant.name = *name;
    const std::uint32_t set = reader.half(at + 4);
    if (set > static_cast<std::uint32_t>(Constant::Set::Sampler))
        return error(fmt::format("{} is in the unknown register set {}", *name, set));
    constant.set = static_cast<Constant::Set>(set);
    constant.index = static_cast<int>(reader.half(at + 6));
    constant.count = static_cast<int>(reader.half(at + 8));
    if (constant.count < 1) return error(fmt::format("{} has no registers", *name));
    if (auto status = read_shape(reader, reader.word(at + 12), constant); !status)
        return status.error();
    return constant;
}

}  // namespace

std::vector<std::uint32_t> build_constant_table(const Shader& shader, std::uint32_t version) {
    std::vector<Constant> sorted = shader.constants;
    std::sort(sorted.begin(), sorted.end(), [](const Constant& a, const Constant& b) {
        return a.name != b.name ? a.name < b.name : comes_before(a, b);
    });
    Bytes bytes;
    bytes.resize(header_size + sorted.size() * constant_size);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const Constant& constant = sorted[i];
        const std::size_t row = header_size + i * constant_size;
        bytes.set_word(row, bytes.string(constant.name));
        bytes.align();
        bytes.set_word(row + 4, static_cast<std::uint32_t>(constant.set) |
                                    static_cast<std::uint32_t>(constant.index) << 16);
        bytes.set_word(row + 8, static_cast<std::uint32_t>(constant.count));
        bytes.set_word(row + 12, bytes.size());
        write_type(bytes, constant, shader);
    }
    bytes.set_word(0, header_size);
    bytes.set_word(8, version);
    bytes.set_word(12, static_cast<std::uint32_t>(sorted.size()));
    bytes.set_word(16, header_size);
    bytes.set_word(24, bytes.string(name_of(shader.profile)));
    bytes.set_word(4, bytes.string(creator));
    bytes.align();
    return bytes.words();
}

Result<ConstantTable> parse_constant_table(std::span<const std::uint32_t> words) {
    const Reader reader(words);
    if (!reader.has(0, header_size) || reader.word(0) < header_size)
        return error("the header is too short");
    const std::size_t count = reader.word(12), rows = reader.word(16);
    if (count > reader.size() / constant_size || !reader.has(rows, count * constant_size))
        return error(fmt::format("{} entries at byte {} do not fit", count, rows));
    ConstantTable table;
    if (reader.word(24) != 0) {
        const auto target = reader.string(reader.word(24));
        if (!target) return error("the target's name lies outside");
        table.target = *target;
    }
    for (std::size_t i = 0; i < count; ++i) {
        auto constant = read_constant(reader, rows + i * constant_size);
        if (!constant) return constant.error();
        table.constants.push_back(std::move(*constant));
    }
    std::stable_sort(table.constants.begin(), table.constants.end(), comes_before);
    return table;
}

}  // namespace intaglio::d3d9
