// Arbitrary shaders: every field drawn on its own, within what text and bytecode can say.
#include "tests/unit/d3d9/random_shader.h"

#include <algorithm>
#include <string>

#include "generator/target/d3d9/ops.h"
#include "tests/unit/d3d9/dice.h"

namespace intaglio::d3d9 {
namespace {

class Arbitrary {
  public:
    Arbitrary(std::uint32_t seed, Profile profile) : dice_(seed) { shader_.profile = profile; }

    Shader make() {
        for (int i = dice_.up_to(4); i > 0; --i) shader_.definitions.push_back(definition());
        for (int i = dice_.up_to(6); i > 0; --i) shader_.declarations.push_back(declaration());
        for (int i = dice_.up_to(30); i > 0; --i) shader_.instructions.push_back(instruction());
        for (int i = dice_.up_to(6); i > 0; --i) shader_.constants.push_back(constant(i));
        std::sort(shader_.constants.begin(), shader_.constants.end(), comes_before);
        return shader_;
    }

  private:
    static bool comes_before(const Constant& a, const Constant& b) {
        if (a.set != b.set) return a.set < b.set;
        return a.index != b.index ? a.index < b.index : a.name < b.name;
    }

    File file() {
        for (;;) {
            const auto drawn = static_cast<File>(dice_.up_to(static_cast<int>(File::Label)));
            if (has_file(shader_.profile, drawn)) return drawn;
        }
    }
    int index_of(File drawn) {
        if (!info(drawn).numbered) return 0;
        return dice_.one_in(20) ? last_register : dice_.up_to(31);
    }
    std::optional<Relative> relative(File drawn) {
        if (!info(drawn).numbered || !dice_.one_in(8)) return std::nullopt;
        if (has_file(shader_.profile, File::Address) && dice_.one_in(2))
            return Relative{File::Address, dice_.up_to(3)};
        if (!has_file(shader_.profile, File::LoopCounter)) return std::nullopt;
        return Relative{File::LoopCounter, 0};
    }

    Source source(File drawn) {
        Source result;
        result.file = drawn;
        result.index = index_of(drawn);
        result.relative = relative(drawn);
        result.modifier = static_cast<Modifier>(dice_.up_to(4));
        if (dice_.one_in(3)) result.swizzle = replicate(dice_.up_to(3));
        if (dice_.one_in(3))
            for (auto& component : result.swizzle)
                component = static_cast<std::uint8_t>(dice_.up_to(3));
        return result;
    }
    Destination destination(File drawn) {
        Destination result;
        result.file = drawn;
        result.index = index_of(drawn);
        result.mask = static_cast<Mask>(1 + dice_.up_to(14));
        result.saturate = dice_.one_in(4);
        result.partial_precision = dice_.one_in(4);
        result.centroid = dice_.one_in(10);
        return result;
    }

    Instruction instruction() {
        Instruction result;
        const auto ops = all_ops();
        const OpInfo& row =
            ops[static_cast<std::size_t>(dice_.up_to(static_cast<int>(ops.size()) - 1))];
        result.op = row.op;
        if (row.has(Trait::Compares))
            result.comparison = static_cast<Comparison>(1 + dice_.up_to(5));
        if (row.has_destination()) {
            result.destination = destination(file());
            result.destination->relative = relative(result.destination->file);
        }
        for (int i = source_count(row.op, shader_.profile); i > 0; --i)
            result.sources.push_back(source(file()));
        if (dice_.one_in(6)) {
            result.predicate = source(File::Predicate);
            result.predicate->relative.reset();
        }
        return result;
    }

    Declaration declaration() {
        Declaration result;
        File drawn = file();
        while (!can_declare(drawn)) drawn = file();
        result.target = destination(drawn);
        if (has_usage(shader_.profile, drawn)) {
            result.usage = static_cast<Usage>(dice_.up_to(static_cast<int>(Usage::Sample)));
            result.usage_index = dice_.up_to(15);
        }
        if (drawn == File::Sampler) result.sampler = static_cast<SamplerKind>(dice_.up_to(3));
        return result;
    }

    Definition definition() {
        Definition result;
        result.file = dice_.pick({File::Const, File::Const, File::ConstInt, File::ConstBool});
        result.index = dice_.up_to(40);
        if (result.file == File::ConstBool) {
            result.bits[0] = dice_.one_in(2);
            return result;
        }
        for (auto& bits : result.bits)
            bits = result.file == File::Const ? dice_.float_bits() : dice_.bits();
        return result;
    }

    Constant constant(int serial) {
        Constant result;
        result.name = "name_" + std::to_string(dice_.up_to(9)) + "_" + std::to_string(serial);
        result.set = static_cast<Constant::Set>(dice_.up_to(3));
        result.index = dice_.up_to(30);
        result.count = 1 + dice_.up_to(8);
        result.elements = dice_.one_in(2) ? 1 : 1 + dice_.up_to(20);
        const bool sampler = result.set == Constant::Set::Sampler;
        result.columns = sampler ? 0 : 1 + dice_.up_to(3);
        result.rows = !sampler && dice_.one_in(4) ? 1 + dice_.up_to(3) : 1;
        return result;
    }

    Dice dice_;
    Shader shader_;
};

}  // namespace

Shader random_shader(std::uint32_t seed, Profile profile) {
    return Arbitrary(seed, profile).make();
}

}  // namespace intaglio::d3d9
