// Random well-typed modules: every op, nested loops with early exits, ifs, texture reads, names,
// origins, and values that no instruction defines.  The same seed and options give the same module
// everywhere.  For properties that hold for all modules: parse(print(m)) == m, and a pass does not
// change what a module computes.
#pragma once

#include <string>
#include <vector>

#include "generator/ir/builder.h"
#include "generator/ir/module.h"
#include "tests/unit/ir/random.h"

namespace intaglio::ir::testing {

struct RandomModuleOptions {
    int instructions = 40;  // about how many, over all regions
    int max_depth = 3;      // loops and ifs inside each other
    int max_trips = 5;      // of each loop
    bool special_constants =
        true;                   // NaN, infinities, denormals; otherwise constants lie in [-4, 4]
    bool samples = true;        // explicit texture reads
    bool derivatives = true;    // implicit texture reads, ddx and ddy, outside loops and ifs
    bool device_ops = true;     // ops that the ops table calls inexact (div, sqrt, dot, ...)
    bool odd_text = true;       // names, comments and files with quotes, spaces and line breaks
    bool unused_values = true;  // values of the module that no instruction defines
};

class RandomModule {
  public:
    RandomModule(std::uint64_t seed, const RandomModuleOptions& options)
        : random_(seed), options_(options), builder_(module_) {}

    Module make() {
        declare();
        visible_.emplace_back();
        fill(options_.instructions);
        std::vector<ValueId> outputs;
        for (const Declaration& output : module_.outputs) outputs.push_back(pick(output.type));
        builder_.finish(outputs);
        for (Value& value : module_.values)
            if (value.name.empty() && random_.chance(30)) value.name = text("v");
        return std::move(module_);
    }

  private:
    // --- declarations
    // -------------------------------------------------------------------------------------------
    std::string text(const std::string& stem) {
        static const std::string odd[] = {"",   " ",  "\"", "\\",       "\n",
                                          "\t", "//", "%3", "\xc3\xa9", "$1"};
        std::string result = stem;
        result += std::to_string(random_.below(100));
        if (options_.odd_text && random_.chance(30))
            result.append(odd[random_.below(10)]).append("tail");
        return result;
    }

    Type float_type() { return {Scalar::Float, random_.between(1, 4)}; }
    Type any_type() {
        const int kind = random_.below(10);
        return {kind < 7   ? Scalar::Float
                : kind < 9 ? Scalar::Int
                           : Scalar::Bool,
                random_.between(1, 4)};
    }

    void declare() {
        module_.name = text("module");
        const bool function = random_.chance(50);
        module_.stage = function ? Stage::Function : Stage::Pixel;
        const auto distinct = [&](int index) {
            return text(std::string("n").append(std::to_string(index)).append("_"));
        };
        const int inputs = random_.between(1, 4), outputs = random_.between(1, 3);
        for (int i = 0; i < inputs; ++i) {
            const Type type = function ? any_type() : float_type();
            module_.inputs.push_back(
                {distinct(i), type, function ? Semantic::Parameter : Semantic::Interpolant});
        }
        for (int i = 0; i < outputs; ++i) {
            const Type type = function ? any_type() : float_type();
            module_.outputs.push_back(
                {distinct(i), type, function ? Semantic::Result : Semantic::Target});
        }
        const int uniforms = random_.between(0, 3), samplers = random_.between(0, 2);
        for (int i = 0; i < uniforms; ++i) {
            Uniform uniform;
            uniform.name = distinct(i);
            uniform.type = any_type();
            uniform.count = random_.chance(50) ? 1 : random_.between(2, 4);
            if (random_.chance(50)) uniform.comment = text("in units of ");
            module_.uniforms.push_back(uniform);
        }
        for (int i = 0; i < samplers; ++i)
            module_.samplers.push_back(
                {distinct(i), random_.chance(70) ? 2 : 3, random_.chance(50) ? text("c") : "",
                 random_.chance(70) ? Sampler::Filter::Linear : Sampler::Filter::Nearest,
                 random_.chance(70) ? "" : text("steps=")});
        for (int i = random_.below(3); i > 0; --i) module_.files.push_back(text("dir/file"));
        for (int i = random_.below(3); i > 0; --i)
            module_.steps.push_back({text("step"), text("What it does, ")});
    }

    // --- values
    // -------------------------------------------------------------------------------------------------
    float constant_component() {
        return options_.special_constants ? random_.any_float() : random_.unit() * 8.0f - 4.0f;
    }

    ValueId constant(Type type) {
        std::array<std::uint32_t, 4> bits{};
        for (int i = 0; i < type.width; ++i) {
            std::uint32_t& component = bits[static_cast<std::size_t>(i)];
            if (type.scalar == Scalar::Float) component = float_bits(constant_component());
            if (type.scalar == Scalar::Bool)
                component = static_cast<std::uint32_t>(random_.below(2));
            if (type.scalar == Scalar::Int)
                component = random_.chance(80) ? static_cast<std::uint32_t>(random_.between(-8, 8))
                                               : static_cast<std::uint32_t>(random_.bits());
        }
        return keep(builder_.constant(type, bits));
    }

    ValueId keep(ValueId id) {
        visible_.back().push_back(id);
        return id;
    }

    // A visible value of the type, or a new constant.
    ValueId pick(Type type) {
        std::vector<ValueId> candidates;
        for (const auto& scope : visible_)
            for (ValueId id : scope)
                if (module_.type(id) == type) candidates.push_back(id);
        if (candidates.empty() || random_.chance(10)) return constant(type);
        return candidates[static_cast<std::size_t>(
            random_.below(static_cast<int>(candidates.size())))];
    }

    std::vector<ValueId> pick_all(const std::vector<Type>& types) {
        std::vector<ValueId> ids;
        for (Type type : types) ids.push_back(pick(type));
        return ids;
    }

    void emit(Op op, const std::vector<Type>& types) {
        const std::vector<ValueId> operands = pick_all(types);
        keep(builder_.emit(op, operands));
    }

    // --- regions
    // ------------------------------------------------------------------------------------------------
    // Appends about this many instructions to the open region.
    void fill(int count) {
        while (count > 0) {
            place_origin();
            if (options_.unused_values && random_.chance(2))
                module_.add_value(any_type(), text("unused"));
            const bool nest =
                builder_.depth() < options_.max_depth && count > 4 && random_.chance(15);
            if (nest) {
                const int inner = random_.between(1, count / 2);
                if (random_.chance(60))
                    loop(inner);
                else
                    branch(inner);
                count -= inner + 1;
            } else {
                instruction();
                --count;
            }
        }
    }

    void place_origin() {
        Origin origin;
        if (!module_.files.empty() && random_.chance(70)) {
            origin.file = random_.below(static_cast<int>(module_.files.size()));
            origin.line = random_.between(0, 300);
        }
        if (!module_.steps.empty() && random_.chance(70))
            origin.step = random_.below(static_cast<int>(module_.steps.size()));
        builder_.set_origin(origin);
    }

    std::vector<Type> some_types(int least) {
        std::vector<Type> types;
        for (int i = random_.between(least, 3); i > 0; --i) types.push_back(any_type());
        return types;
    }

    void loop(int count) {
        const std::vector<Type> types = some_types(0);
        const std::vector<ValueId> initial = pick_all(types);
        LoopInfo info;
        info.name = text("loop");
        info.trip_count = random_.between(0, options_.max_trips);
        info.form = static_cast<LoopForm>(random_.below(3));
        info.closed_form = random_.chance(20);
        const Builder::LoopScope scope = builder_.begin_loop(info, initial);
        visible_.push_back(scope.carried);
        visible_.back().push_back(scope.index);
        const int breaks = random_.below(3);
        for (int i = 0; i < breaks; ++i) {
            fill(count / 3);
            const ValueId condition = pick(bool1);
            const std::vector<ValueId> carried = pick_all(types);
            builder_.break_if(condition, carried);
        }
        fill(count - breaks * (count / 3));
        const std::vector<ValueId> next = pick_all(types);
        visible_.pop_back();
        for (ValueId result : builder_.end_loop(next)) keep(result);
    }

    void branch(int count) {
        const std::vector<Type> types = some_types(0);
        builder_.begin_if(pick(bool1));
        visible_.emplace_back();
        fill(count / 2);
        builder_.begin_else(pick_all(types));
        visible_.back().clear();
        fill(count - count / 2);
        const std::vector<ValueId> values = pick_all(types);
        visible_.pop_back();
        for (ValueId result : builder_.end_if(values)) keep(result);
    }

    // --- one instruction
    // ----------------------------------------------------------------------------------------
    void instruction() {
        const auto ops = all_ops();
        const OpInfo& row =
            ops[static_cast<std::size_t>(random_.below(static_cast<int>(ops.size())))];
        const bool wanted =
            (options_.device_ops || row.bit_exact || is_sample(row.op) ||
             needs_derivatives(row.op)) &&
            (!needs_derivatives(row.op) || (options_.derivatives && builder_.depth() == 0));
        if (!wanted) return instruction();
        const Type type = any_type();
        const auto count = static_cast<std::size_t>(row.operand_count < 0 ? 0 : row.operand_count);
        switch (row.type_rule) {
            case TypeRule::Leaf: return leaf(row.op, type);
            case TypeRule::SameNumeric:
                return emit(row.op,
                            std::vector(count, type.scalar == Scalar::Bool ? float2 : type));
            case TypeRule::SameFloat:
            case TypeRule::Dot:
                return emit(row.op, std::vector(count, Type{Scalar::Float, type.width}));
            case TypeRule::Cross: return emit(row.op, {float3, float3});
            case TypeRule::Compare:
                return emit(row.op, std::vector(count, random_.chance(70) ? float1 : int1));
            case TypeRule::Logic: return emit(row.op, std::vector(count, bool1));
            case TypeRule::Select: return emit(row.op, {bool1, type, type});
            case TypeRule::ToFloat: return emit(row.op, {{Scalar::Int, type.width}});
            case TypeRule::Compose: return compose(type.scalar);
            case TypeRule::Swizzle: return swizzle(type);
            case TypeRule::Sample: return sample(row.op);
            default: return instruction();  // loops and ifs have their own quota
        }
    }

    void leaf(Op op, Type type) {
        if (op == Op::Input) {
            keep(builder_.input(random_.below(static_cast<int>(module_.inputs.size()))));
        } else if (op == Op::Uniform && !module_.uniforms.empty()) {
            const int slot = random_.below(static_cast<int>(module_.uniforms.size()));
            const int element =
                random_.below(module_.uniforms[static_cast<std::size_t>(slot)].count);
            keep(builder_.uniform(slot, element));
        } else {
            constant(type);
        }
    }

    void compose(Scalar scalar) {
        std::vector<Type> types;
        int room = 4;
        const int parts = random_.between(2, 4);
        for (int left = parts; left > 0; --left) {
            types.push_back({scalar, random_.between(1, room - (left - 1))});
            room -= types.back().width;
        }
        const std::vector<ValueId> operands = pick_all(types);
        keep(builder_.compose(operands));
    }

    void swizzle(Type source) {
        const ValueId value = pick(source);
        std::string letters;
        for (int i = random_.between(1, 4); i > 0; --i)
            letters += "xyzw"[random_.below(source.width)];
        if (letters != std::string("xyzw").substr(0, static_cast<std::size_t>(source.width)))
            keep(builder_.swizzle(value, letters));
    }

    void sample(Op op) {
        if (module_.samplers.empty() || !options_.samples) return instruction();
        const int slot = random_.below(static_cast<int>(module_.samplers.size()));
        const Type coordinate{Scalar::Float,
                              module_.samplers[static_cast<std::size_t>(slot)].dimension};
        const ValueId position = pick(coordinate);
        if (op == Op::SampleImplicit) {
            keep(builder_.sample(op, slot, {position}));
        } else if (op == Op::SampleLevel) {
            const ValueId level = pick(float1);
            keep(builder_.sample(op, slot, {position, level}));
        } else {
            const ValueId dx = pick(coordinate), dy = pick(coordinate);
            keep(builder_.sample(op, slot, {position, dx, dy}));
        }
    }

    Random random_;
    RandomModuleOptions options_;
    Module module_;
    Builder builder_;
    std::vector<std::vector<ValueId>> visible_;  // by scope, innermost last
};

inline Module random_module(std::uint64_t seed, const RandomModuleOptions& options = {}) {
    return RandomModule(seed, options).make();
}

}  // namespace intaglio::ir::testing
