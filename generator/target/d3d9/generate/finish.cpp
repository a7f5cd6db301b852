// The last step: everything gets its number.
#include "generator/target/d3d9/generate/finish.h"

#include <algorithm>
#include <bit>
#include <map>
#include <set>

#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

class Finish {
  public:
    Finish(const ir::Module& module, Profile profile)
        : module_(module), limits_(limits_of(profile)) {
        result_.shader.profile = profile;
        result_.shader.files = module.files;
        result_.shader.steps = module.steps;
    }

    Finished run(const Graph& graph, const std::vector<int>& order) {
        int next = 0;
        const std::vector<int> uniforms = assign_uniforms(module_, graph, next);
        graph_ = &graph;
        Code code = place(graph, order, limits_, uniforms);
        Allocation allocation = allocate(code, limits_);
        if (limits_.pixel()) {
            Code merged = code;
            coalesce(merged);
            Allocation with_less = allocate(merged, limits_);
            if (!with_less.failure || allocation.failure) {
                code = std::move(merged);
                allocation = std::move(with_less);
            }
        }
        Limits unlimited = limits_;
        unlimited.constants = no_limit;
        result_.shader.definitions = *pool_constants(code, unlimited, next);
        result_.failure = allocation.failure;
        result_.failed_at = allocation.failed_at;
        for (const VirtualInstruction& instruction : code.instructions)
            result_.shader.instructions.push_back(convert(instruction, allocation));
        declare(code, uniforms);
        return std::move(result_);
    }
    // What has its registers already.
    Shader number(const Graph& graph, Code code, const std::vector<int>& uniforms, int next) {
        graph_ = &graph;
        Limits unlimited = limits_;
        unlimited.constants = no_limit;
        result_.shader.definitions = *pool_constants(code, unlimited, next);
        Allocation allocation;
        for (std::size_t k = 0; k < code.lanes.size(); ++k)
            allocation.places.push_back({static_cast<int>(k), 0, 0});
        for (const VirtualInstruction& instruction : code.instructions)
            result_.shader.instructions.push_back(is_flow(instruction.op)
                                                      ? convert_flow(instruction, allocation)
                                                      : convert(instruction, allocation));
        declare(code, uniforms);
        return std::move(result_.shader);
    }

  private:
    static bool is_flow(Opcode op) { return info(op).has(Trait::Flow); }
    Instruction convert_flow(const VirtualInstruction& from, const Allocation& allocation) {
        Instruction to;
        to.op = from.op;
        to.origin = from.origin;
        to.comparison = from.comparison;
        for (const VirtualSource& source : from.sources) {
            to.sources.push_back(convert(source, allocation));
            to.sources.back().swizzle = replicate(source.swizzle[0]);
        }
        if (from.op == Opcode::Rep) {
            Source count;
            count.file = File::ConstInt;
            count.index = integer(from.repeats);
            to.sources = {count};
        }
        return to;
    }
    // The i# that is defined as this count.
    int integer(int count) {
        int next = 0;
        for (const Definition& definition : result_.shader.definitions) {
            if (definition.file != File::ConstInt) continue;
            if (definition.bits[0] == static_cast<std::uint32_t>(count)) return definition.index;
            ++next;
        }
        Definition definition;
        definition.file = File::ConstInt;
        definition.index = next;
        definition.bits = {static_cast<std::uint32_t>(count), 0, 0, 0};
        result_.shader.definitions.push_back(definition);
        return next;
    }

    bool model_3() const { return limits_.model_3(); }
    File input_file() const { return model_3() || !limits_.pixel() ? File::Input : File::Texture; }
    // oC# and oDepth; oPos and oT#, or o0 and from o1 on.
    Destination output(int number) const {
        Destination destination;
        if (limits_.pixel()) {
            const auto k = static_cast<std::size_t>(number);
            destination.file =
                graph_->kind_of_output(k) == OutputKind::Depth ? File::DepthOut : File::ColourOut;
            for (std::size_t i = 0; i < k && destination.file == File::ColourOut; ++i)
                destination.index += graph_->kind_of_output(i) == OutputKind::Colour;
            return destination;
        }
        const int index = graph_->output_places[static_cast<std::size_t>(number)].index;
        const bool position = index == position_output;
        destination.file = model_3()  ? File::Output
                           : position ? File::PositionOut
                                      : File::TexcoordOut;
        destination.index = model_3() ? index + 1 : position ? 0 : index;
        return destination;
    }

    static Allocation::Place place_of(const Allocation& allocation, int index) {
        Allocation::Place place = allocation.places[static_cast<std::size_t>(index)];
        if (place.number < 0) place.number = 0;  // allocation failed before it
        return place;
    }

    Instruction convert(const VirtualInstruction& from, const Allocation& allocation) const {
        Instruction to;
        to.op = from.op;
        to.origin = from.origin;
        if (from.op == Opcode::Texkill) {
            const Source tested = convert(from.sources[0], allocation);
            to.destination = Destination{.file = tested.file, .index = tested.index};
            return to;
        }
        Destination destination;
        if (from.output >= 0) {
            destination = output(from.output);
            destination.mask = destination.file == File::DepthOut ? full_mask : from.mask;
            destination.saturate = from.saturate;
        } else {
            const Allocation::Place place = place_of(allocation, from.target);
            destination.index = place.number;
            destination.mask = static_cast<Mask>(place.shift >= 0 ? from.mask << place.shift
                                                                  : from.mask >> -place.shift);
            destination.saturate = from.saturate;
        }
        to.destination = destination;
        const bool texture = from.sampler >= 0;
        // The one lane may have moved, and what it sees must move with it.
        const bool scalar = from.output < 0 || destination.file == File::DepthOut;
        const bool one_lane = scalar && !texture && !is_dot(from.op) &&
                              std::has_single_bit(static_cast<unsigned>(from.mask));
        const int lane = std::countr_zero(static_cast<unsigned>(from.mask));
        for (std::size_t k = 0; k < from.sources.size(); ++k) {
            VirtualSource source = from.sources[k];
            if (one_lane)
                source.swizzle = replicate(source.swizzle[static_cast<std::size_t>(lane)]);
            to.sources.push_back(convert(source, allocation));
            if (texture && k == 0) to.sources.push_back(sampler_source(from));
        }
        return to;
    }
    static Source sampler_source(const VirtualInstruction& read) {
        Source source;
        source.file = File::Sampler;
        source.index = read.sampler;
        source.swizzle = read.sampler_swizzle;
        return source;
    }
    Source convert(const VirtualSource& from, const Allocation& allocation) const {
        Source to;
        to.index = from.index;
        to.swizzle = from.swizzle;
        to.modifier = from.negate ? Modifier::Negate : Modifier::None;
        if (from.absolute) to.modifier = from.negate ? Modifier::AbsNegate : Modifier::Abs;
        if (from.kind == VirtualSource::Kind::Input) to.file = input_file();
        if (from.kind == VirtualSource::Kind::Constant || from.kind == VirtualSource::Kind::Uniform)
            to.file = File::Const;
        if (from.kind == VirtualSource::Kind::Temp) {
            const Allocation::Place place = place_of(allocation, from.index);
            to.index = place.number;
            if (place.shift != 0) to.swizzle = replicate(place.only_lane + place.shift);
        }
        return to;
    }

    void declare(const Code& code, const std::vector<int>& uniforms) {
        std::set<int> inputs;
        std::vector<char> samplers(module_.samplers.size());
        for (const VirtualInstruction& instruction : code.instructions) {
            if (instruction.sampler >= 0)
                samplers[static_cast<std::size_t>(instruction.sampler)] = 1;
            for (const VirtualSource& source : instruction.sources)
                if (source.kind == VirtualSource::Kind::Input) inputs.insert(source.index);
        }
        for (const int index : inputs) declare_input(index);
        if (!limits_.pixel() && model_3()) declare_outputs();
        add_uniforms(uniforms);
        for (std::size_t i = 0; i < samplers.size(); ++i) {
            if (samplers[i] == 0) continue;
            Declaration declaration;
            declaration.target.file = File::Sampler;
            declaration.target.index = static_cast<int>(i);
            declaration.sampler =
                module_.samplers[i].dimension == 3 ? SamplerKind::Volume : SamplerKind::Texture2D;
            result_.shader.declarations.push_back(declaration);
            Constant constant;
            constant.name = module_.samplers[i].name;
            constant.set = Constant::Set::Sampler;
            constant.index = static_cast<int>(i);
            constant.columns = 0;
            result_.shader.constants.push_back(constant);
        }
    }
    void declare_input(int index) {
        Declaration declaration;
        declaration.target.file = input_file();
        declaration.target.index = index;
        const unsigned lanes = lanes_of_register(graph_->inputs, index);
        declaration.target.mask = static_cast<Mask>(lanes);
        if (!limits_.pixel()) {
            const AttributeUsage usage = graph_->attributes[static_cast<std::size_t>(index)];
            declaration.usage = usage.usage;
            declaration.usage_index = usage.index;
            if (!model_3()) declaration.target.mask = full_mask;
        } else if (model_3()) {
            declaration.usage = Usage::Texcoord;
            declaration.usage_index = index;
        } else {  // t# are declared from .x on without a gap
            declaration.target.mask = static_cast<Mask>((1u << std::bit_width(lanes)) - 1);
        }
        result_.shader.declarations.push_back(declaration);
    }
    void declare_outputs() {
        std::map<int, Declaration> declarations;
        for (std::size_t k = 0; k < graph_->output_places.size(); ++k) {
            const int index = graph_->output_places[k].index;
            Declaration& declaration = declarations[index];
            declaration.target = output(static_cast<int>(k));
            declaration.target.mask = index == position_output
                                          ? full_mask
                                          : lanes_of_register(graph_->output_places, index);
            declaration.usage = index == position_output ? Usage::Position : Usage::Texcoord;
            declaration.usage_index = std::max(index, 0);
        }
        for (const auto& [index, declaration] : declarations)
            result_.shader.declarations.push_back(declaration);
    }
    void add_uniforms(const std::vector<int>& uniforms) {
        for (std::size_t i = 0; i < uniforms.size(); ++i) {
            if (uniforms[i] < 0) continue;
            const ir::Uniform& uniform = module_.uniforms[i];
            Constant constant;
            constant.name = uniform.name;
            constant.index = uniforms[i];
            constant.count = uniform.count;
            constant.columns = uniform.type.width;
            constant.elements = uniform.count;
            result_.shader.constants.push_back(constant);
        }
    }

    const ir::Module& module_;
    const Limits& limits_;
    const Graph* graph_ = nullptr;
    Finished result_;
};

}  // namespace

std::vector<int> assign_uniforms(const ir::Module& module, const Graph& graph, int& next) {
    std::vector<char> used(module.uniforms.size());
    const auto mark = [&](const Operand& operand) {
        for (const Lane lane : operand.lanes)
            if (graph.node(lane).kind == Node::Kind::Uniform)
                used[static_cast<std::size_t>(graph.node(lane).slot)] = 1;
    };
    for (const int index : order_of(graph, Order::Depth))
        for (const Operand& operand : graph.nodes[static_cast<std::size_t>(index)].operands)
            mark(operand);
    for (const Operand& output : graph.outputs) mark(output);
    std::vector<int> registers(module.uniforms.size(), -1);
    next = 0;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i] == 0) continue;
        registers[i] = next;
        next += module.uniforms[i].count;
    }
    return registers;
}

Finished finish(const ir::Module& module, const Graph& graph, const std::vector<int>& order,
                Profile profile) {
    return Finish(module, profile).run(graph, order);
}

Shader finish_flow(const ir::Module& module, const Graph& graph, const Code& code,
                   const std::vector<int>& uniforms, int next, Profile profile) {
    return Finish(module, profile).number(graph, code, uniforms, next);
}

}  // namespace intaglio::d3d9
