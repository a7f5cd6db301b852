// The machine: one or four pixels in step, each with its registers, under a mask of those that take
// part.  Blocks remember the mask to restore; a break takes its pixels out of every block up to its
// loop.  Texture coordinates and gradients come from all four pixels, whatever the mask.
#include "generator/target/d3d9/interpret.h"

#include <algorithm>

#include "generator/target/d3d9/interpret_unit.h"

namespace intaglio::d3d9 {
namespace {

using Step = Interpreter::Prepared::Step;
using Pixels = unsigned;  // bit i: pixel i takes part

constexpr long instruction_limit = 1L << 22;
constexpr std::size_t call_limit = 8, frame_limit = 96;

struct Frame {
    enum class Kind { Branch, Loop, Call } kind = Kind::Branch;
    Pixels after = 0;                   // who goes on behind the block
    Pixels otherwise = 0;               // Branch: who takes the else
    int remaining = 0;                  // Loop: turns after this one
    int counter = 0, counter_step = 0;  // Loop: aL
    std::size_t resume = 0;             // Call: the instruction behind it
};

bool holds(Comparison comparison, float a, float b) {
    switch (comparison) {
        case Comparison::Greater: return a > b;
        case Comparison::Equal: return a == b;
        case Comparison::GreaterEqual: return a >= b;
        case Comparison::Less: return a < b;
        case Comparison::NotEqual: return a != b;
        case Comparison::LessEqual: return a <= b;
        case Comparison::None: return false;
    }
    return false;
}

template <std::size_t Count>  // pixels: 1 or 4
class Machine {
  public:
    Machine(const Interpreter::Prepared& prepared, const Environment& environment,
            const Inputs* inputs, Arithmetic arithmetic, std::vector<long>* counts)
        : prepared_(prepared),
          environment_(environment),
          inputs_(inputs),
          arithmetic_(arithmetic),
          counts_(counts) {
        if (counts_ && counts_->size() < prepared.steps.size())
            counts_->resize(prepared.steps.size());
    }

    void run() {
        std::size_t at = 0;
        long executed = 0;
        while (at < prepared_.steps.size()) {
            if (++executed > instruction_limit) complete_ = false;
            if (!complete_) return;
            const Step& step = prepared_.steps[at];
            count(at);
            if (arithmetic_ == Arithmetic::Fp24)
                at = dispatch<Narrow24>(step, at);
            else if (arithmetic_ == Arithmetic::Fp16Partial && step.instruction.destination &&
                     step.instruction.destination->partial_precision)
                at = dispatch<Narrow16>(step, at);
            else
                at = dispatch<Single>(step, at);
        }
    }

    Execution result(std::size_t pixel) const {
        const Registers& from = pixels_[pixel];
        const auto& outputs = from.outputs;
        Execution result;
        const auto copy = [&](auto& into, int slot) {
            std::copy_n(outputs.begin() + slot, into.size(), into.begin());
        };
        copy(result.colours, colour_slot);
        copy(result.diffuse, diffuse_slot);
        copy(result.texcoords, texcoord_slot);
        copy(result.outputs, output_slot);
        result.depth = outputs[depth_slot][0];
        result.position = outputs[position_slot];
        result.fog = outputs[fog_slot];
        result.point_size = outputs[point_size_slot];
        result.killed = from.killed;
        result.texture_reads = from.texture_reads;
        result.instructions = from.instructions;
        result.complete = complete_;
        return result;
    }

  private:
    static constexpr Pixels all = (1u << Count) - 1;

    template <typename F>
    void each_active(F action) {
        for (std::size_t pixel = 0; pixel < Count; ++pixel)
            if (active_ >> pixel & 1) action(pixel);
    }

    void count(std::size_t at) {
        each_active([&](std::size_t pixel) {
            ++pixels_[pixel].instructions;
            if (counts_) ++(*counts_)[at];
        });
    }

    template <typename A>
    Unit<A> unit(std::size_t pixel) const {
        return {prepared_, environment_, inputs_[pixel], pixels_[pixel], loop_counter()};
    }

    int loop_counter() const {
        for (std::size_t i = depth_; i-- > 0;)
            if (frames_[i].kind == Frame::Kind::Loop && frames_[i].counter_step != no_counter)
                return frames_[i].counter;
        return 0;
    }

    // Carries out one instruction; the index of the next one.
    template <typename A>
    std::size_t dispatch(const Step& step, std::size_t at) {
        const Instruction& instruction = step.instruction;
        switch (instruction.op) {
            case Opcode::Nop: return at + 1;
            case Opcode::Label: return prepared_.steps.size();  // behind the end of main
            case Opcode::Call:
            case Opcode::CallNz:
            case Opcode::Ret:
            case Opcode::Loop:
            case Opcode::Rep:
            case Opcode::EndLoop:
            case Opcode::EndRep:
            case Opcode::If:
            case Opcode::IfComp:
            case Opcode::Else:
            case Opcode::EndIf:
            case Opcode::Break:
            case Opcode::BreakComp:
            case Opcode::BreakP: return flow<A>(step, at);
            case Opcode::SetP: set_predicate<A>(instruction); return at + 1;
            case Opcode::Texkill: kill<A>(instruction); return at + 1;
            case Opcode::Texld:
            case Opcode::Texldb:
            case Opcode::Texldp:
            case Opcode::Texldd:
            case Opcode::Texldl: sample<A>(step); return at + 1;
            case Opcode::Dsx:
            case Opcode::Dsy: differ<A>(step); return at + 1;
            default:
                each_active([&](std::size_t pixel) {
                    write<A>(step, pixel, unit<A>(pixel).compute(instruction));
                });
                return at + 1;
        }
    }

    bool predicate_at(const Source& predicate, std::size_t pixel, std::size_t lane) const {
        const bool value = pixels_[pixel].predicate[predicate.swizzle[lane]];
        return value != (predicate.modifier == Modifier::Not);
    }

    template <typename A>
    void write(const Step& step, std::size_t pixel, const Vector& value) {
        const Destination& destination = *step.instruction.destination;
        Registers& registers = pixels_[pixel];
        const auto index = static_cast<std::size_t>(destination.index);
        int output = step.output;
        if (destination.relative) output += loop_counter();
        if (output >= output_slot_count) return;
        Vector& into = output >= 0 ? registers.outputs[static_cast<std::size_t>(output)]
                                   : registers.temps[index];
        for (std::size_t lane = 0; lane < 4; ++lane) {
            if (!(destination.mask >> lane & 1)) continue;
            const auto& predicate = step.instruction.predicate;
            if (predicate && !predicate_at(*predicate, pixel, lane)) continue;
            if (destination.file == File::Address) {
                // To the nearest; what no int holds counts as 0.
                const float v = value[lane];
                registers.address[lane] =
                    std::fabs(v) < 1e6f ? static_cast<int>(std::nearbyint(v)) : 0;
                continue;
            }
            into[lane] = destination.saturate ? A::saturate(value[lane]) : value[lane];
        }
        if (step.instruction.op == Opcode::SinCos && prepared_.loses_sincos) {
            into[2] = std::numeric_limits<float>::quiet_NaN();
            if (destination.mask == 0x1) into[1] = into[2];
        }
    }

    template <typename A>
    void set_predicate(const Instruction& instruction) {
        each_active([&](std::size_t pixel) {
            const Unit<A> on = unit<A>(pixel);
            const Vector a = on.read(instruction.sources[0]), b = on.read(instruction.sources[1]);
            for (std::size_t lane = 0; lane < 4; ++lane)
                if (instruction.destination->mask >> lane & 1)
                    pixels_[pixel].predicate[lane] =
                        holds(instruction.comparison, a[lane], b[lane]);
        });
    }

    // The first three components are tested, as the validator's demands on declarations say.
    template <typename A>
    void kill(const Instruction& instruction) {
        const Destination& tested = *instruction.destination;
        Source source;
        source.file = tested.file;
        source.index = tested.index;
        each_active([&](std::size_t pixel) {
            const Vector value = unit<A>(pixel).read(source);
            for (std::size_t lane = 0; lane < 3; ++lane) {
                if (!(tested.mask >> lane & 1) || !(value[lane] < 0)) continue;
                const auto& predicate = instruction.predicate;
                if (!predicate || predicate_at(*predicate, pixel, lane))
                    pixels_[pixel].killed = true;
            }
        });
    }

    // Values of all four pixels to differences along x (bit 0 of the pixel) or y (bit 1).
    template <typename A>
    static Vector difference(const std::array<Vector, Count>& values, std::size_t pixel,
                             std::size_t axis) {
        Vector result{};
        if constexpr (Count == 4) {
            const Vector& high = values[pixel | axis];
            const Vector& low = values[pixel & ~axis];
            for (std::size_t i = 0; i < 4; ++i) result[i] = A::sub(high[i], low[i]);
        }
        return result;
    }

    template <typename A>
    std::array<Vector, Count> read_all(const Source& source) const {
        std::array<Vector, Count> values;
        for (std::size_t pixel = 0; pixel < Count; ++pixel)
            values[pixel] = unit<A>(pixel).read(source);
        return values;
    }

    template <typename A>
    void differ(const Step& step) {
        const auto values = read_all<A>(step.instruction.sources[0]);
        const std::size_t axis = step.instruction.op == Opcode::Dsx ? 1 : 2;
        each_active(
            [&](std::size_t pixel) { write<A>(step, pixel, difference<A>(values, pixel, axis)); });
    }

    static std::array<float, 3> xyz(const Vector& v) { return {v[0], v[1], v[2]}; }

    template <typename A>
    void sample(const Step& step) {
        const Instruction& instruction = step.instruction;
        const auto index = static_cast<std::size_t>(step.sampler);
        const ir::Texture* texture =
            index < environment_.samplers.size() ? environment_.samplers[index] : nullptr;
        // The address unit keeps the full precision of its registers; `_pp` rounds the result.
        using Address = std::conditional_t<std::is_same_v<A, Narrow16>, Single, A>;
        auto coordinates = read_all<Address>(instruction.sources[0]);
        if (instruction.op == Opcode::Texldp)
            for (Vector& c : coordinates)
                c = {Address::div(c[0], c[3]), Address::div(c[1], c[3]), Address::div(c[2], c[3]),
                     c[3]};
        each_active([&](std::size_t pixel) {
            const Vector& coordinate = coordinates[pixel];
            Vector texel{};
            if (texture) {
                const auto level = level_of<Address>(instruction, *texture, coordinates, pixel);
                texel = ir::sample_level(*texture, xyz(coordinate), level);
            }
            Vector value{};
            const Swizzle& swizzle = instruction.sources[1].swizzle;
            for (std::size_t i = 0; i < 4; ++i) value[i] = A::load(texel[swizzle[i]]);
            ++pixels_[pixel].texture_reads;
            write<A>(step, pixel, value);
        });
    }

    template <typename A>
    float level_of(const Instruction& instruction, const ir::Texture& texture,
                   const std::array<Vector, Count>& coordinates, std::size_t pixel) const {
        if (instruction.op == Opcode::Texldl) return coordinates[pixel][3];
        const float bias = instruction.op == Opcode::Texldb ? coordinates[pixel][3] : 0.0f;
        if (instruction.op == Opcode::Texldd) {
            const Unit<A> on = unit<A>(pixel);
            return ir::level_of_gradients(texture, xyz(on.read(instruction.sources[2])),
                                          xyz(on.read(instruction.sources[3])));
        }
        if constexpr (Count == 1) return bias;
        return bias + ir::level_of_gradients(texture, xyz(difference<A>(coordinates, pixel, 1)),
                                             xyz(difference<A>(coordinates, pixel, 2)));
    }

    // Who of the active pixels meets the condition of an if, break or call.
    template <typename A>
    Pixels condition(const Instruction& instruction) {
        Pixels meeting = 0;
        each_active([&](std::size_t pixel) {
            if (meets<A>(instruction, pixel)) meeting |= 1u << pixel;
        });
        return meeting;
    }

    template <typename A>
    bool meets(const Instruction& instruction, std::size_t pixel) const {
        if (instruction.comparison != Comparison::None) {
            const Unit<A> on = unit<A>(pixel);
            return holds(instruction.comparison, on.read(instruction.sources[0])[0],
                         on.read(instruction.sources[1])[0]);
        }
        if (instruction.sources.empty() || instruction.op == Opcode::Call) return true;
        const Source& source = instruction.sources.back();
        if (source.file == File::Predicate) return predicate_at(source, pixel, 0);
        const auto index = static_cast<std::size_t>(source.index);
        const bool value =
            prepared_.boolean_defined[index]
                ? prepared_.boolean_definitions[index]
                : index < environment_.booleans.size() && environment_.booleans[index];
        return value != (source.modifier == Modifier::Not);
    }

    bool push(const Frame& frame) {
        if (depth_ == frame_limit) {
            complete_ = false;
            return false;
        }
        frames_[depth_++] = frame;
        return true;
    }

    template <typename A>
    std::size_t flow(const Step& step, std::size_t at) {
        const Instruction& instruction = step.instruction;
        switch (instruction.op) {
            case Opcode::If:
            case Opcode::IfComp: {
                const Pixels taken = condition<A>(instruction);
                push(
                    {.kind = Frame::Kind::Branch, .after = active_, .otherwise = active_ & ~taken});
                active_ = taken;
                return taken ? at + 1 : static_cast<std::size_t>(step.target);
            }
            case Opcode::Else:
                active_ = frames_[depth_ - 1].otherwise;
                return active_ ? at + 1 : static_cast<std::size_t>(step.target);
            case Opcode::EndIf: active_ = frames_[--depth_].after; return at + 1;
            case Opcode::Rep:
            case Opcode::Loop: return enter_loop(step, at);
            case Opcode::EndRep:
            case Opcode::EndLoop: return repeat(step, at);
            case Opcode::Ret: return leave_call();
            case Opcode::Call:
            case Opcode::CallNz: return call(step, at, condition<A>(instruction));
            default: leave_loop(condition<A>(instruction)); return at + 1;
        }
    }

    std::size_t enter_loop(const Step& step, std::size_t at) {
        const auto index = static_cast<std::size_t>(step.instruction.sources.back().index);
        std::array<int, 4> bounds{};
        if (prepared_.integer_defined[index])
            bounds = prepared_.integer_definitions[index];
        else if (index < environment_.integers.size())
            bounds = environment_.integers[index];
        Frame frame{.kind = Frame::Kind::Loop, .after = active_};
        frame.remaining = std::clamp(bounds[0], 0, 255) - 1;  // the reference's ranges
        frame.counter = std::clamp(bounds[1], 0, 255);
        frame.counter_step =
            step.instruction.op == Opcode::Loop ? std::clamp(bounds[2], -128, 127) : no_counter;
        if (!push(frame)) return at;
        if (bounds[0] > 0) return at + 1;
        active_ = 0;
        return static_cast<std::size_t>(step.target);
    }

    std::size_t repeat(const Step& step, std::size_t at) {
        Frame& frame = frames_[depth_ - 1];
        if (active_ && frame.remaining-- > 0) {
            if (frame.counter_step != no_counter) frame.counter += frame.counter_step;
            return static_cast<std::size_t>(step.target) + 1;
        }
        active_ = frame.after;
        --depth_;
        return at + 1;
    }

    void leave_loop(Pixels leaving) {
        active_ &= ~leaving;
        for (std::size_t i = depth_; i-- > 0 && frames_[i].kind == Frame::Kind::Branch;) {
            frames_[i].after &= ~leaving;
            frames_[i].otherwise &= ~leaving;
        }
    }

    std::size_t call(const Step& step, std::size_t at, Pixels taken) {
        if (!taken) return at + 1;
        if (calls_ == call_limit) complete_ = false;
        if (!complete_ || !push({.kind = Frame::Kind::Call, .after = active_, .resume = at + 1}))
            return at;
        ++calls_;
        active_ = taken;
        return static_cast<std::size_t>(step.target) + 1;
    }

    std::size_t leave_call() {
        if (calls_ == 0) return prepared_.steps.size();
        --calls_;
        const Frame& frame = frames_[--depth_];
        active_ = frame.after;
        return frame.resume;
    }

    static constexpr int no_counter = std::numeric_limits<int>::min();  // rep has no aL

    const Interpreter::Prepared& prepared_;
    const Environment& environment_;
    const Inputs* inputs_;
    Arithmetic arithmetic_;
    std::vector<long>* counts_;
    std::array<Registers, Count> pixels_{};
    std::array<Frame, frame_limit> frames_{};
    std::size_t depth_ = 0, calls_ = 0;
    Pixels active_ = all;
    bool complete_ = true;
};

}  // namespace

Execution Interpreter::run(const Environment& environment, const Inputs& inputs,
                           Arithmetic arithmetic, std::vector<long>* counts) const {
    Machine<1> machine(*prepared_, environment, &inputs, arithmetic, counts);
    machine.run();
    return machine.result(0);
}

std::array<Execution, 4> Interpreter::run_quad(const Environment& environment,
                                               const std::array<Inputs, 4>& inputs,
                                               Arithmetic arithmetic,
                                               std::vector<long>* counts) const {
    Machine<4> machine(*prepared_, environment, inputs.data(), arithmetic, counts);
    machine.run();
    return {machine.result(0), machine.result(1), machine.result(2), machine.result(3)};
}

}  // namespace intaglio::d3d9
