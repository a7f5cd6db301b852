// Legal shaders: every register is written first, then random instructions whose operands are drawn
// within the rules of the profile, then the outputs.  The rules are those that Direct3D's validator
// was seen to enforce.
#include <algorithm>
#include <array>
#include <string>

#include "generator/target/d3d9/ops.h"
#include "tests/unit/d3d9/dice.h"
#include "tests/unit/d3d9/random_shader.h"

namespace intaglio::d3d9 {
namespace {

constexpr int defined_constants = 4, last_constant = 11, temps = 8, samplers = 3;
constexpr Swizzle restricted_swizzles[] = {identity_swizzle, replicate(0), replicate(1),
                                           replicate(2),     replicate(3), {1, 2, 0, 3},
                                           {2, 0, 1, 3},     {3, 2, 1, 0}};

class Legal {
  public:
    Legal(std::uint32_t seed, Profile profile) : dice_(seed), profile_(profile) {
        shader_.profile = profile;
    }

    Shader make() {
        declare();
        initialise();
        const int count = 4 + dice_.up_to(profile_ == Profile::ps_2_0 ? 14 : 40);
        for (int i = 0; i < count; ++i) statement();
        write_outputs();
        if (called_) subroutine();
        return shader_;
    }

  private:
    bool pixel() const { return is_pixel(profile_); }
    bool model_3() const { return profile_ == Profile::ps_3_0 || profile_ == Profile::vs_3_0; }
    bool restricted() const { return profile_ == Profile::ps_2_0 || profile_ == Profile::ps_2_b; }
    bool pixel_2() const { return pixel() && !model_3(); }

    static Source source(File file, int index, const Swizzle& swizzle = identity_swizzle) {
        Source result;
        result.file = file;
        result.index = index;
        result.swizzle = swizzle;
        return result;
    }
    static Destination destination(File file, int index, Mask mask = full_mask) {
        Destination result;
        result.file = file;
        result.index = index;
        result.mask = mask;
        return result;
    }
    Instruction& emit(Opcode op, std::optional<Destination> to, std::vector<Source> from) {
        Instruction instruction;
        instruction.op = op;
        instruction.destination = to;
        instruction.sources = std::move(from);
        shader_.instructions.push_back(std::move(instruction));
        return shader_.instructions.back();
    }

    void declare_input(File file, int index, Usage usage, Mask mask = full_mask) {
        Declaration declaration;
        declaration.target = destination(file, index, mask);
        if (has_usage(profile_, file)) declaration.usage = usage;
        shader_.declarations.push_back(declaration);
    }

    void constant(std::string name, Constant::Set set, int index, int count, int columns) {
        Constant result;
        result.name = std::move(name);
        result.set = set;
        result.index = index;
        result.count = result.elements = count;
        result.columns = columns;
        shader_.constants.push_back(std::move(result));
    }

    void declare() {
        for (int i = 0; i < defined_constants; ++i)
            shader_.definitions.push_back(
                {File::Const,
                 i,
                 {dice_.float_bits(), dice_.float_bits(), dice_.float_bits(), dice_.float_bits()}});
        if (info(Opcode::Rep).is_in(profile_)) {
            shader_.definitions.push_back({File::ConstInt, 0, {3, 0, 1, 0}});
            shader_.definitions.push_back(
                {File::ConstBool, 0, {dice_.one_in(2) ? 1u : 0u, 0, 0, 0}});
        }
        constant("tint", Constant::Set::Float4, defined_constants, 1, 3);
        constant("rows", Constant::Set::Float4, defined_constants + 1,
                 last_constant - defined_constants, 4);
        if (pixel_2()) {
            declare_input(File::Texture, 0, Usage::Texcoord);
            declare_input(File::Texture, 1, Usage::Texcoord);
            declare_input(File::Input, 0, Usage::Color);
        } else {
            declare_input(File::Input, 0, pixel() ? Usage::Texcoord : Usage::Position);
            declare_input(File::Input, 1, Usage::Color);
        }
        if (profile_ == Profile::ps_3_0) {
            declare_input(File::Position, 0, Usage::Position, 0x3);
            declare_input(File::Face, 0, Usage::Position);
        }
        if (profile_ == Profile::vs_3_0) {
            declare_input(File::Output, 0, Usage::Position);
            declare_input(File::Output, 1, Usage::Texcoord, 0x3);
        }
        for (int i = 0; has_file(profile_, File::Sampler) && i < samplers; ++i) {
            Declaration declaration;
            declaration.target = destination(File::Sampler, i);
            declaration.sampler = static_cast<SamplerKind>(i + 1);
            shader_.declarations.push_back(declaration);
            constant("map" + std::to_string(i), Constant::Set::Sampler, i, 1, 0);
        }
    }

    Source input() {
        if (pixel_2() && dice_.one_in(2)) return source(File::Texture, dice_.up_to(1));
        return source(File::Input, pixel_2() ? 0 : dice_.up_to(1));
    }

    void initialise() {
        for (int i = 0; i < temps; ++i) set_again(i);
        if (!pixel()) emit(Opcode::Mova, destination(File::Address, 0), {source(File::Input, 0)});
        if (info(Opcode::SetP).is_in(profile_))
            emit(Opcode::SetP, destination(File::Predicate, 0),
                 {source(File::Temp, 0), source(File::Temp, 1)})
                .comparison = static_cast<Comparison>(1 + dice_.up_to(5));
    }
    void set_again(int temp) {
        emit(Opcode::Mov, destination(File::Temp, temp),
             {dice_.one_in(2) ? input() : source(File::Const, dice_.up_to(last_constant))});
    }

    Swizzle swizzle() {
        if (restricted()) return restricted_swizzles[static_cast<std::size_t>(dice_.up_to(7))];
        if (dice_.one_in(3)) return identity_swizzle;
        Swizzle result{};
        for (auto& component : result) component = static_cast<std::uint8_t>(dice_.up_to(3));
        return result;
    }

    // Operands of one instruction: at most one constant, read at most twice, and one input.
    struct Ports {
        std::optional<Source> constant;
        std::optional<Source> input;
        int constant_reads = 0;
    };

    Source arithmetic_source(Ports& ports, bool scalar) {
        Source result = source(File::Temp, dice_.up_to(temps - 1));
        if (dice_.one_in(4) && ports.constant_reads < 2) {
            if (!ports.constant) ports.constant = some_constant();
            result = *ports.constant;
            ++ports.constant_reads;
        } else if (dice_.one_in(4)) {
            if (!ports.input) ports.input = some_input();
            result = *ports.input;
        }
        result.swizzle = scalar ? replicate(dice_.up_to(3)) : swizzle();
        // Constants keep their modifier: _abs on one of two reads of a constant is refused.
        if (result.file != File::Const && !result.relative) result.modifier = some_modifier();
        return result;
    }
    Modifier some_modifier() {
        if (model_3() && dice_.one_in(6)) return dice_.pick({Modifier::Abs, Modifier::AbsNegate});
        return dice_.one_in(4) ? Modifier::Negate : Modifier::None;
    }
    Source some_constant() {
        Source result = source(File::Const, dice_.up_to(last_constant));
        if (!pixel() && dice_.one_in(4)) result.relative = Relative{File::Address, dice_.up_to(3)};
        if (!pixel() && in_loop_ && dice_.one_in(3))
            result.relative = Relative{File::LoopCounter, 0};
        // _abs with an address is disassembled unreadably.
        if (!result.relative) result.modifier = some_modifier();
        return result;
    }
    Source some_input() {
        Source result = input();
        if (profile_ == Profile::ps_3_0 && in_loop_ && dice_.one_in(3)) {
            result = source(File::Input, 0);
            result.relative = Relative{File::LoopCounter, 0};
        }
        return result;
    }

    // A register that none of the sources is.
    int temp_apart_from(const std::vector<Source>& sources) {
        for (;;) {
            const int drawn = dice_.up_to(temps - 1);
            const auto clashes = [&](const Source& s) {
                return s.file == File::Temp && s.index == drawn;
            };
            if (std::none_of(sources.begin(), sources.end(), clashes)) return drawn;
        }
    }

    void note_write(const Instruction& instruction) {
        int order = order_[static_cast<std::size_t>(instruction.destination->index)];
        for (const Source& s : instruction.sources)
            if (s.file == File::Temp)
                order = std::max(order, order_[static_cast<std::size_t>(s.index)]);
        order_[static_cast<std::size_t>(instruction.destination->index)] = order;
    }

    void arithmetic() {
        static constexpr Opcode choices[] = {
            Opcode::Mov, Opcode::Add, Opcode::Mad, Opcode::Mul, Opcode::Rcp, Opcode::Rsq,
            Opcode::Dp3, Opcode::Dp4, Opcode::Min, Opcode::Max, Opcode::Slt, Opcode::Sge,
            Opcode::Exp, Opcode::Log, Opcode::Lit, Opcode::Dst, Opcode::Lrp, Opcode::Frc,
            Opcode::Pow, Opcode::Crs, Opcode::Abs, Opcode::Nrm, Opcode::Cmp, Opcode::Dp2Add,
            Opcode::Dsx, Opcode::Dsy};
        const OpInfo& row = info(choices[static_cast<std::size_t>(
            dice_.up_to(static_cast<int>(std::size(choices)) - 1))]);
        if (!row.is_in(profile_) || (row.has(Trait::NeedsGradients) && depth_ > 0)) return;
        Ports ports;
        std::vector<Source> sources;
        for (int i = 0; i < row.sources; ++i)
            sources.push_back(arithmetic_source(ports, (row.scalar_sources >> i & 1) != 0));
        if (row.op == Opcode::Dsx || row.op == Opcode::Dsy) sources[0].modifier = Modifier::None;
        Destination to =
            destination(File::Temp, dice_.up_to(temps - 1), static_cast<Mask>(1 + dice_.up_to(14)));
        if (row.has(Trait::Macro)) to.index = temp_apart_from(sources);
        if (row.op == Opcode::Nrm) to.mask = dice_.pick<Mask>({0x7, 0xF});
        if (row.op == Opcode::Crs) {
            to.mask = static_cast<Mask>(1 + dice_.up_to(6));
            for (Source& s : sources) s.swizzle = identity_swizzle;
        }
        to.saturate = profile_ != Profile::vs_2_0 && row.op != Opcode::Frc && dice_.one_in(4);
        to.partial_precision = pixel() && dice_.one_in(4);
        Instruction& added = emit(row.op, to, std::move(sources));
        const bool can_predicate = info(Opcode::SetP).is_in(profile_) && !row.has(Trait::Macro) &&
                                   !row.has(Trait::NeedsGradients);
        if (can_predicate && dice_.one_in(6)) {
            added.predicate = source(
                File::Predicate, 0, dice_.one_in(2) ? identity_swizzle : replicate(dice_.up_to(3)));
            if (dice_.one_in(2)) added.predicate->modifier = Modifier::Not;
        }
        note_write(added);
    }

    void matrix() {
        const auto op =
            dice_.pick({Opcode::M4x4, Opcode::M4x3, Opcode::M3x4, Opcode::M3x3, Opcode::M3x2});
        const int rows = info(op).matrix_rows;
        const std::vector<Source> sources = {
            source(File::Temp, dice_.up_to(temps - 1)),
            source(File::Const, dice_.up_to(last_constant - rows + 1))};
        note_write(emit(
            op,
            destination(File::Temp, temp_apart_from(sources), static_cast<Mask>((1 << rows) - 1)),
            sources));
    }

    // What sincos and sgn leave undefined is written again.
    void sine() {
        std::vector<Source> sources = {
            source(File::Temp, dice_.up_to(temps - 1), replicate(dice_.up_to(3)))};
        if (!model_3())
            sources.insert(sources.end(), {source(File::Const, 0), source(File::Const, 1)});
        const int to = temp_apart_from(sources);
        note_write(emit(Opcode::SinCos,
                        destination(File::Temp, to, static_cast<Mask>(1 + dice_.up_to(2))),
                        sources));
        set_again(to);
    }
    void sign() {
        std::vector<Source> sources = {source(File::Temp, 0, swizzle()), source(File::Temp, 1),
                                       source(File::Temp, 2)};
        emit(Opcode::Sgn, destination(File::Temp, 3), sources);
        for (int i = 0; i < 4; ++i) set_again(i);
    }

    void texture() {
        const auto op = pixel() ? dice_.pick({Opcode::Texld, Opcode::Texldb, Opcode::Texldp,
                                              Opcode::Texldd, Opcode::Texldl, Opcode::Texkill})
                                : Opcode::Texldl;
        const OpInfo& row = info(op);
        if (!row.is_in(profile_) || (row.has(Trait::NeedsGradients) && depth_ > 0)) return;
        Source coordinate = dice_.one_in(2)
                                ? source(File::Temp, dice_.up_to(temps - 1))
                                : source(pixel_2() ? File::Texture : File::Input, dice_.up_to(1));
        const int to = dice_.up_to(temps - 1);
        auto& order =
            order_[static_cast<std::size_t>(op == Opcode::Texkill ? coordinate.index : to)];
        if (pixel_2() && (op != Opcode::Texkill || coordinate.file == File::Temp)) {
            int before = order;
            if (coordinate.file == File::Temp)
                before = std::max(before, order_[static_cast<std::size_t>(coordinate.index)]);
            if (before + 1 > 3) return;
            order = before + 1;
        }
        if (op == Opcode::Texkill) {
            emit(op, destination(coordinate.file, coordinate.index), {});
            return;
        }
        std::vector<Source> sources = {coordinate,
                                       source(File::Sampler, dice_.up_to(samplers - 1))};
        if (op == Opcode::Texldd)
            sources.insert(sources.end(), {source(File::Temp, 0), source(File::Temp, 1)});
        Destination target = destination(File::Temp, to);
        if (profile_ == Profile::ps_3_0) {
            target.mask = static_cast<Mask>(1 + dice_.up_to(14));
            sources[0].swizzle = swizzle();
            sources[1].swizzle = swizzle();
        }
        target.partial_precision = pixel() && dice_.one_in(4);
        emit(op, target, std::move(sources));
    }

    void statement() {
        const int drawn = dice_.up_to(19);
        if (drawn < 4 && has_file(profile_, File::Sampler))
            texture();
        else if (drawn == 4)
            matrix();
        else if (drawn == 5 && dice_.one_in(3) && depth_ == 0)
            sine();
        else if (drawn == 6 && !pixel() && depth_ == 0)
            sign();
        else if (drawn < 9 && info(Opcode::If).is_in(profile_) && depth_ < 2)
            block();
        else if (drawn == 9)
            facing();
        else if (drawn == 10)
            emit(Opcode::Nop, std::nullopt, {});
        else
            arithmetic();
    }

    void facing() {
        if (profile_ != Profile::ps_3_0) return;
        emit(Opcode::Cmp, destination(File::Temp, 0),
             {source(File::Face, 0), source(File::Temp, 1), source(File::Temp, 2)});
        emit(Opcode::Mul, destination(File::Temp, 1, 0x3),
             {source(File::Position, 0, {0, 1, 0, 0}), source(File::Temp, 3)});
    }

    Source scalar_temp() {
        return source(File::Temp, dice_.up_to(temps - 1), replicate(dice_.up_to(3)));
    }

    void body() {
        ++depth_;
        for (int i = dice_.up_to(4); i >= 0; --i) statement();
        --depth_;
    }

    void block() {
        if (++blocks_ > 6) return;  // vs_2_0 takes 16 static branches, else and call among them
        switch (dice_.up_to(4)) {
            case 0: return conditional();
            case 1: return repeat(false);
            case 2: return repeat(true);
            case 3:
                if (depth_ == 0 && !called_) {
                    called_ = true;
                    emit(Opcode::Call, std::nullopt, {source(File::Label, 0)});
                }
                return;
            default:
                if (called_ && depth_ == 0)
                    emit(Opcode::CallNz, std::nullopt,
                         {source(File::Label, 0), source(File::ConstBool, 0)});
        }
    }

    void conditional() {
        const bool dynamic = model_3() && dice_.one_in(2);
        if (dynamic && dice_.one_in(2)) {
            emit(Opcode::IfComp, std::nullopt, {scalar_temp(), scalar_temp()}).comparison =
                static_cast<Comparison>(1 + dice_.up_to(5));
        } else {
            Source condition = dynamic ? source(File::Predicate, 0, replicate(dice_.up_to(3)))
                                       : source(File::ConstBool, 0);
            if (dynamic && dice_.one_in(2)) condition.modifier = Modifier::Not;
            emit(Opcode::If, std::nullopt, {condition});
        }
        body();
        if (dice_.one_in(2)) {
            emit(Opcode::Else, std::nullopt, {});
            body();
        }
        emit(Opcode::EndIf, std::nullopt, {});
    }

    void repeat(bool counts) {
        if (in_repeat_) return;
        in_repeat_ = true;
        in_loop_ = counts;
        std::vector<Source> operands = {source(File::ConstInt, 0)};
        if (counts) operands.insert(operands.begin(), source(File::LoopCounter, 0));
        emit(counts ? Opcode::Loop : Opcode::Rep, std::nullopt, operands);
        body();
        if (model_3() && dice_.one_in(2))
            emit(Opcode::BreakComp, std::nullopt, {scalar_temp(), scalar_temp()}).comparison =
                static_cast<Comparison>(1 + dice_.up_to(5));
        emit(counts ? Opcode::EndLoop : Opcode::EndRep, std::nullopt, {});
        in_repeat_ = in_loop_ = false;
    }

    void write_outputs() {
        const Source r = source(File::Temp, dice_.up_to(temps - 1));
        if (pixel()) {
            emit(Opcode::Mov, destination(File::ColourOut, 0), {r});
            if (dice_.one_in(4))
                emit(Opcode::Mov, destination(File::ColourOut, 1), {source(File::Const, 0)});
            if (dice_.one_in(4)) emit(Opcode::Mov, destination(File::DepthOut, 0), {scalar_temp()});
        } else if (model_3()) {
            emit(Opcode::Mov, destination(File::Output, 0), {r});
            emit(Opcode::Add, destination(File::Output, 1, 0x3),
                 {r, source(File::Temp, 0, swizzle())});
        } else {
            emit(Opcode::Mov, destination(File::PositionOut, 0), {r});
            emit(Opcode::Mov, destination(File::TexcoordOut, dice_.up_to(7), 0x3), {r});
            emit(Opcode::Mov, destination(File::AttributeOut, dice_.up_to(1)), {r});
            if (dice_.one_in(3)) emit(Opcode::Mov, destination(File::FogOut, 0), {scalar_temp()});
            if (dice_.one_in(3))
                emit(Opcode::Mov, destination(File::PointSizeOut, 0), {scalar_temp()});
        }
    }

    void subroutine() {
        emit(Opcode::Ret, std::nullopt, {});
        emit(Opcode::Label, std::nullopt, {source(File::Label, 0)});
        ++depth_;
        for (int i = 0; i < 3; ++i) arithmetic();
        emit(Opcode::Ret, std::nullopt, {});
    }

    Dice dice_;
    Profile profile_;
    Shader shader_;
    std::array<int, temps> order_{};  // dependent-read order of each temp
    int depth_ = 0, blocks_ = 0;
    bool in_repeat_ = false, in_loop_ = false;
    bool called_ = false;
};

}  // namespace

Shader random_legal_shader(std::uint32_t seed, Profile profile) {
    return Legal(seed, profile).make();
}

}  // namespace intaglio::d3d9
