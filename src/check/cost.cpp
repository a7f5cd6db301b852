// Counting, on the instruction stream that SPIRV-Tools' binary parser delivers.
#include "src/check/cost.h"

#include <spirv-tools/libspirv.h>
#include <spirv/unified1/spirv.hpp11>

#include <map>
#include <memory>
#include <set>
#include <vector>

#include "src/check/control_flow.h"
#include "src/check/spirv.h"

namespace intaglio::check {
namespace {

using Id = std::uint32_t;

struct Block {
    SpirvCost cost;
    std::vector<Id> successors;  // labels
    std::vector<Id> calls;
    Id label = 0;
    Id loop_merge = 0;
    bool ends = false;
};

struct Function {
    std::vector<Block> blocks;
};

struct Module {
    Id entry = 0;
    std::map<Id, Function> functions;
    std::set<Id> handle_types;  // of images and samplers: loading one costs nothing
};

enum class Class { Free, Alu, Texture, Branch, Memory };

bool within(spv::Op op, spv::Op first, spv::Op last) { return op >= first && op <= last; }

// The numbers of SPIR-V's opcodes are grouped by kind (SPIR-V 1.3, section 3.32).
Class class_of(spv::Op op) {
    switch (op) {
        case spv::Op::OpImage:
        case spv::Op::OpSampledImage:
        case spv::Op::OpImageTexelPointer: return Class::Free;
        case spv::Op::OpImageRead:
        case spv::Op::OpImageWrite:
        case spv::Op::OpLoad:
        case spv::Op::OpStore:
        case spv::Op::OpCopyMemory:
        case spv::Op::OpCopyMemorySized: return Class::Memory;
        case spv::Op::OpBranchConditional:
        case spv::Op::OpSwitch:
        case spv::Op::OpKill: return Class::Branch;
        case spv::Op::OpExtInst:
        case spv::Op::OpTranspose:
        case spv::Op::OpVectorExtractDynamic:
        case spv::Op::OpVectorInsertDynamic: return Class::Alu;
        case spv::Op::OpBitcast: return Class::Free;
        default: break;
    }
    if (within(op, spv::Op::OpImageSampleImplicitLod, spv::Op::OpImageDrefGather) ||
        within(op, spv::Op::OpImageQueryFormat, spv::Op::OpImageQuerySamples)) {
        return Class::Texture;
    }
    if (within(op, spv::Op::OpConvertFToU, spv::Op::OpBitCount) ||  // conversion, arithmetic, logic
        within(op, spv::Op::OpDPdx, spv::Op::OpFwidthCoarse)) {
        return Class::Alu;
    }
    if (within(op, spv::Op::OpAtomicLoad, spv::Op::OpAtomicXor)) return Class::Memory;
    return Class::Free;
}

void count(Class kind, SpirvCost& cost) {
    switch (kind) {
        case Class::Free: return;
        case Class::Alu: ++cost.alu; break;
        case Class::Texture: ++cost.texture; break;
        case Class::Branch: ++cost.branch; break;
        case Class::Memory: ++cost.memory; break;
    }
    ++cost.total;
}

// Builds a Module from instructions in order.
class Collector {
  public:
    void take(const spv_parsed_instruction_t& instruction) {
        const std::uint32_t* word = instruction.words;
        const auto op = static_cast<spv::Op>(instruction.opcode);
        switch (op) {
            case spv::Op::OpEntryPoint:
                if (module_.entry == 0) module_.entry = word[2];
                return;
            case spv::Op::OpTypeImage:
            case spv::Op::OpTypeSampler:
            case spv::Op::OpTypeSampledImage: module_.handle_types.insert(word[1]); return;
            case spv::Op::OpFunction: function_ = &module_.functions[word[2]]; return;
            case spv::Op::OpFunctionEnd: function_ = nullptr; return;
            case spv::Op::OpLabel:
                function_->blocks.emplace_back();
                function_->blocks.back().label = word[1];
                return;
            default: break;
        }
        if (function_ == nullptr || function_->blocks.empty()) return;
        Block& block = function_->blocks.back();
        take_flow(op, instruction, block);
        const bool is_handle =
            op == spv::Op::OpLoad && module_.handle_types.count(instruction.type_id) > 0;
        if (!is_handle) count(class_of(op), block.cost);
    }

    Module module() && { return std::move(module_); }

  private:
    static void take_flow(spv::Op op, const spv_parsed_instruction_t& instruction, Block& block) {
        const std::uint32_t* word = instruction.words;
        switch (op) {
            case spv::Op::OpLoopMerge: block.loop_merge = word[1]; break;
            case spv::Op::OpBranch: block.successors = {word[1]}; break;
            case spv::Op::OpBranchConditional: block.successors = {word[2], word[3]}; break;
            case spv::Op::OpSwitch: take_switch(instruction, block); break;
            case spv::Op::OpReturn:
            case spv::Op::OpReturnValue:
            case spv::Op::OpKill: block.ends = true; break;
            case spv::Op::OpFunctionCall: block.calls.push_back(word[3]); break;
            default: break;
        }
    }

    // Selector, default, then pairs of literal and label; literals may be wide, so the parsed
    // operands tell.
    static void take_switch(const spv_parsed_instruction_t& instruction, Block& block) {
        for (std::uint16_t i = 1; i < instruction.num_operands; ++i) {
            const spv_parsed_operand_t& operand = instruction.operands[i];
            if (operand.type == SPV_OPERAND_TYPE_ID) {
                block.successors.push_back(instruction.words[operand.offset]);
            }
        }
    }

    Module module_;
    Function* function_ = nullptr;
};

spv_result_t take_instruction(void* collector, const spv_parsed_instruction_t* instruction) {
    static_cast<Collector*>(collector)->take(*instruction);
    return SPV_SUCCESS;
}

Result<Module> read_module(const SpirvWords& words) {
    const std::unique_ptr<spv_context_t, void (*)(spv_context)> context(
        spvContextCreate(SPV_ENV_VULKAN_1_1), spvContextDestroy);
    Collector collector;
    if (spvBinaryParse(context.get(), &collector, words.data(), words.size(), nullptr,
                       take_instruction, nullptr) != SPV_SUCCESS) {
        return input_error("spirv-unreadable", "SPIRV-Tools cannot read the module");
    }
    return std::move(collector).module();
}

class Counter {
  public:
    Counter(const Module& module, int loop_bound) : module_(module), loop_bound_(loop_bound) {}

    // Adds the function, and those it calls, to `cost` at first sight; nullopt: no path ends.
    // The validator has excluded recursion.
    std::optional<PathCost> visit(Id id, SpirvCost& cost) {
        if (const auto known = known_.find(id); known != known_.end()) return known->second;
        const Function& function = module_.functions.at(id);
        std::map<Id, int> index;
        for (const Block& block : function.blocks) {
            index.emplace(block.label, static_cast<int>(index.size()));
        }
        std::vector<FlowBlock> flow(function.blocks.size());
        for (std::size_t i = 0; i < flow.size(); ++i) {
            const Block& block = function.blocks[i];
            for (const Id label : block.successors) flow[i].successors.push_back(index.at(label));
            flow[i].ends = block.ends;
            if (block.loop_merge != 0) flow[i].loop_merge = index.at(block.loop_merge);
            flow[i].cost = {block.cost.total, block.cost.total};
        }
        const std::vector<bool> runs = reachable_blocks(flow);
        for (std::size_t i = 0; i < flow.size(); ++i) {
            if (!runs[i]) continue;
            add(function.blocks[i].cost, cost);
            for (const Id callee : function.blocks[i].calls) {
                const std::optional<PathCost> called = visit(callee, cost);
                if (!called) return std::nullopt;
                flow[i].cost.shortest += called->shortest;
                flow[i].cost.longest += called->longest;
            }
        }
        return known_[id] = path_cost(flow, loop_bound_);
    }

  private:
    static void add(const SpirvCost& part, SpirvCost& sum) {
        sum.alu += part.alu;
        sum.texture += part.texture;
        sum.branch += part.branch;
        sum.memory += part.memory;
        sum.total += part.total;
    }

    const Module& module_;
    const int loop_bound_;
    std::map<Id, std::optional<PathCost>> known_;
};

}  // namespace

Result<SpirvCost> count_spirv(const SpirvWords& words, int loop_bound) {
    if (loop_bound < 0) return input_error("bad-bound", "a loop bound is zero or more");
    if (Status valid = validate_spirv(words); !valid) return valid.error();
    const Result<Module> module = read_module(words);
    if (!module) return module.error();
    SpirvCost cost;
    const std::optional<PathCost> path = Counter(*module, loop_bound).visit(module->entry, cost);
    if (!path) return input_error("endless", "no path through the shader comes to an end");
    cost.shortest_path = path->shortest;
    cost.longest_path = path->longest;
    return cost;
}

}  // namespace intaglio::check
