// A program is declarations, writes to a few temps, random instructions, sometimes in blocks, and a
// mov to oC0.
#include "tests/unit/d3d9_legality/random_program.h"

#include <initializer_list>
#include <random>
#include <vector>

#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
    bool one_in(int n) { return below(n) == 0; }
    template <typename T>
    T among(std::initializer_list<T> values) {
        return *(values.begin() + below(static_cast<int>(values.size())));
    }

  private:
    std::mt19937 engine_;
};

Swizzle any_swizzle(Random& random) {
    Swizzle swizzle{};
    for (auto& component : swizzle) component = static_cast<std::uint8_t>(random.below(4));
    return swizzle;
}

class Program {
  public:
    Program(Profile profile, unsigned seed) : random_(seed) { shader_.profile = profile; }

    Shader make() {
        declare();
        for (int r = 0; r < 3; ++r) put(Opcode::Mov, destination(r), {Source{File::Const, r}});
        body(3 + random_.below(14), 0);
        put(Opcode::Mov, Destination{File::ColourOut, slip() ? random_.below(5) : 0},
            {Source{File::Temp, temp()}});
        return shader_;
    }

  private:
    bool model_3() const { return shader_.profile == Profile::ps_3_0; }
    bool slip() { return random_.one_in(90); }
    int temp() { return slip() ? random_.below(14) : random_.below(4); }

    void declare() {
        const auto lanes = [&] {
            return slip() ? static_cast<Mask>(1 + random_.below(15))
                          : random_.among<Mask>({3, 7, 15, 15, 15});
        };
        for (int i = 0; i < 3; ++i) {
            Declaration input;
            input.target = {model_3() ? File::Input : File::Texture, i, lanes()};
            input.usage = Usage::Texcoord;
            input.usage_index = slip() ? 0 : i;
            shader_.declarations.push_back(input);
            Declaration sampler;
            sampler.target = {File::Sampler, i};
            sampler.sampler = random_.among({SamplerKind::Texture2D, SamplerKind::Texture2D,
                                             SamplerKind::Cube, SamplerKind::Volume});
            if (!slip()) shader_.declarations.push_back(sampler);
        }
        if (!model_3())
            shader_.declarations.push_back({{File::Input, 0}, Usage::Color, 0, SamplerKind::None});
        if (model_3() && random_.one_in(3))
            shader_.declarations.push_back(
                {{File::Position, 0, 3}, Usage::Position, 0, SamplerKind::None});
    }

    Destination destination(int index) { return Destination{File::Temp, index}; }

    void put(Opcode op, std::optional<Destination> d, std::vector<Source> sources,
             Comparison comparison = Comparison::None) {
        Instruction it;
        it.op = op;
        it.destination = d;
        it.sources = std::move(sources);
        it.comparison = comparison;
        shader_.instructions.push_back(it);
    }

    // One constant and one input for all sources of the next instruction.
    void new_ports() {
        constant_ = random_.below(3);
        input_ = random_.below(3);
        input_file_ = model_3() || !random_.one_in(3) ? (model_3() ? File::Input : File::Texture)
                                                      : File::Input;
    }

    Source source(bool scalar) {
        Source s;
        const int kind = random_.below(12);
        s.file = kind < 7 ? File::Temp : kind < 10 ? File::Const : input_file_;
        if (slip())
            s.file = random_.among({File::Texture, File::Sampler, File::ConstInt, File::Position,
                                    File::ColourOut, File::Predicate});
        s.index = s.file == File::Temp    ? temp()
                  : slip()                ? random_.below(3)
                  : s.file == File::Const ? constant_
                                          : input_;
        if (s.file == File::Position || s.file == File::Predicate) s.index = 0;
        if (s.file == File::Input && !model_3() && !slip()) s.index = 0;
        if (scalar != slip()) {
            s.swizzle = replicate(random_.below(4));
        } else if (random_.one_in(3)) {
            s.swizzle = shader_.profile == Profile::ps_2_0 && !slip()
                            ? random_.among<Swizzle>(
                                  {{1, 2, 0, 3}, {2, 0, 1, 3}, {3, 2, 1, 0}, replicate(1)})
                            : any_swizzle(random_);
        }
        if (s.file == File::Position && !slip()) s.swizzle = replicate(random_.below(2));
        if (random_.one_in(6)) s.modifier = Modifier::Negate;
        if (random_.one_in(model_3() ? 20 : 200))
            s.modifier = random_.among({Modifier::Abs, Modifier::AbsNegate});
        return s;
    }

    Destination target(const OpInfo& row) {
        Destination d{File::Temp, temp()};
        if (random_.one_in(3)) d.mask = static_cast<Mask>(1 + random_.below(15));
        if (row.has(Trait::Texture) && !(model_3() && random_.one_in(3)))
            d.mask = slip() ? 7 : full_mask;
        if (!slip()) {
            if (row.op == Opcode::Nrm) d.mask = random_.among<Mask>({7, 15});
            if (row.op == Opcode::Crs) d.mask = static_cast<Mask>(1 + random_.below(7));
            if (row.op == Opcode::SinCos) d.mask = static_cast<Mask>(1 + random_.below(3));
            if (row.op == Opcode::M3x2) d.mask = 3;
            if (row.op == Opcode::M3x3 || row.op == Opcode::M4x3) d.mask = 7;
            if (row.op == Opcode::M3x4 || row.op == Opcode::M4x4) d.mask = 15;
        }
        if (row.op == Opcode::SetP) d = {File::Predicate, 0, d.mask};
        if (slip())
            d.file = random_.among({File::ColourOut, File::DepthOut, File::Texture, File::Const});
        if (model_3() && random_.one_in(25)) d = {File::ColourOut, 0, d.mask};
        if (d.file == File::DepthOut) d = {File::DepthOut, 0};
        if (random_.one_in(row.has(Trait::Texture) ? 100 : 8)) d.saturate = true;
        if (random_.one_in(12)) d.partial_precision = true;
        return d;
    }

    void arithmetic() {
        const auto op = static_cast<Opcode>(random_.below(static_cast<int>(Opcode::Dsy) + 1));
        const OpInfo& row = info(op);
        const bool x = shader_.profile == Profile::ps_2_a;
        if (!row.is_in(shader_.profile) && !(x && slip()) && !slip()) return;
        new_ports();
        Instruction it;
        it.op = op;
        if (row.has_destination()) it.destination = target(row);
        for (int i = 0; i < source_count(op, shader_.profile); ++i)
            it.sources.push_back(source((row.scalar_sources >> i & 1) != 0));
        fit_operands(row, it);
        if (x || model_3()) maybe_predicate(it);
        shader_.instructions.push_back(it);
    }

    void fit_operands(const OpInfo& row, Instruction& it) {
        if (slip()) return;
        if (row.has(Trait::Texture)) {
            for (Source& s : it.sources) {
                s.modifier = Modifier::None;
                if (!model_3()) s.swizzle = identity_swizzle;
            }
            if (it.destination) it.destination->saturate = false;
            if (!it.sources.empty() && it.sources[0].file != File::Temp)
                it.sources[0].file = model_3() ? File::Input : File::Texture;
            if (it.sources.size() > 1) it.sources[1] = {File::Sampler, random_.below(3)};
            if (it.op == Opcode::Texkill && it.destination && !model_3())
                it.destination->mask = full_mask;
        }
        if (row.matrix_rows > 0)
            it.sources[1] = {random_.one_in(4) ? File::Temp : File::Const, random_.below(4)};
        if (row.has(Trait::Macro) && it.destination->file == File::Temp)
            for (Source& s : it.sources)
                if (s.file == File::Temp && s.index == it.destination->index)
                    s.index = (s.index + 1) % 4;
        if (it.op == Opcode::Frc) it.destination->saturate = false;
        if (it.op == Opcode::Crs)
            for (Source& s : it.sources) s.swizzle = identity_swizzle;
        if (it.op == Opcode::SinCos && it.sources.size() == 3) {
            it.sources[1] = {File::Const, 4};
            it.sources[2] = {File::Const, 5};
            it.destination->saturate = false;
        }
    }

    void maybe_predicate(Instruction& it) {
        if (!random_.one_in(15)) return;
        Source p{File::Predicate, 0};
        if (random_.one_in(2)) p.swizzle = replicate(random_.below(4));
        if (random_.one_in(2)) p.modifier = Modifier::Not;
        if (slip()) p.swizzle = any_swizzle(random_);
        it.predicate = p;
    }

    void body(int length, int depth) {
        for (int i = 0; i < length; ++i) {
            const bool flow = shader_.profile != Profile::ps_2_0 && depth < 3;
            if (flow && random_.one_in(9))
                block(length / 2, depth);
            else if (shader_.profile != Profile::ps_2_0 && random_.one_in(20))
                put(Opcode::SetP, Destination{File::Predicate, 0}, {source(false), source(false)},
                    Comparison::Greater);
            else
                arithmetic();
        }
    }

    void block(int length, int depth) {
        const int kind = random_.below(4);
        if (kind == 0)
            put(Opcode::If, {},
                {Source{slip() ? File::ConstInt : File::ConstBool, random_.below(4)}});
        if (kind == 1) put(Opcode::IfComp, {}, {source(true), source(true)}, Comparison::Less);
        if (kind >= 2) put(Opcode::Rep, {}, {Source{File::ConstInt, 0}});
        body(length, depth + 1);
        if (kind >= 2 && random_.one_in(3))
            put(Opcode::BreakComp, {}, {source(true), source(true)}, Comparison::Less);
        if (slip() && random_.one_in(2)) return;
        if (kind < 2 && random_.one_in(3)) {
            put(Opcode::Else, {}, {});
            body(length, depth + 1);
        }
        put(kind >= 2 ? Opcode::EndRep : Opcode::EndIf, {}, {});
    }

    Random random_;
    Shader shader_;
    int constant_ = 0, input_ = 0;
    File input_file_ = File::Input;
};

}  // namespace

Shader random_program(Profile profile, unsigned seed) { return Program(profile, seed).make(); }

Shader random_nonsense(unsigned seed) {
    Random random(seed);
    const auto file = [&] {
        return static_cast<File>(random.below(static_cast<int>(File::Label) + 1));
    };
    const auto index = [&] {
        return random.one_in(30) ? random.below(100000) - 50000 : random.below(6);
    };
    const auto relative = [&]() -> std::optional<Relative> {
        if (!random.one_in(10)) return std::nullopt;
        return Relative{file(), random.below(4)};
    };
    const auto source = [&] {
        return Source{file(), index(), any_swizzle(random), static_cast<Modifier>(random.below(5)),
                      relative()};
    };
    const auto destination = [&] {
        return Destination{file(),           index(),          static_cast<Mask>(random.below(16)),
                           random.one_in(5), random.one_in(5), random.one_in(9),
                           relative()};
    };
    Shader shader;
    shader.profile = static_cast<Profile>(random.below(6));
    for (int i = random.below(5); i > 0; --i)
        shader.declarations.push_back({destination(), static_cast<Usage>(random.below(14)), index(),
                                       static_cast<SamplerKind>(random.below(4))});
    for (int i = random.below(4); i > 0; --i)
        shader.definitions.push_back({file(), index(), {1, 2, 3, 4}});
    for (int i = random.below(30); i > 0; --i) {
        Instruction it;
        it.op = static_cast<Opcode>(random.below(static_cast<int>(Opcode::SetP) + 1));
        const OpInfo& row = info(it.op);
        if (row.has(Trait::Compares) != random.one_in(20)) it.comparison = Comparison::Less;
        if (row.has_destination() != random.one_in(20)) it.destination = destination();
        const int operands =
            random.one_in(15) ? random.below(6) : source_count(it.op, shader.profile);
        for (int s = 0; s < operands; ++s) it.sources.push_back(source());
        if (random.one_in(8)) it.predicate = source();
        shader.instructions.push_back(it);
    }
    return shader;
}

}  // namespace intaglio::d3d9
