// A rep counts to 255.  More iterations are loops in loops: iteration i is i1 * n + i0, and the
// condition that left the inner loop leaves the outer one as well.
#include "generator/passes/rewrite.h"
#include "generator/target/d3d9/generate/flow_blocks.h"

namespace intaglio::d3d9 {
namespace {

using ir::Instruction;
using ir::Op;
using ir::ValueId;

class Splitter {
  public:
    explicit Splitter(ir::Module& module) : module_(module) {}

    void visit(ir::Region& region) {
        passes::rebuild(region, [&](Instruction it, std::vector<Instruction>& body) {
            for (ir::Region& inner : it.regions) visit(inner);
            if (it.op == Op::Loop && it.loop.trip_count > most_repeats)
                split(std::move(it), body);
            else
                body.push_back(std::move(it));
        });
    }

  private:
    // Iterations of the inner loop: as many as leave none over, if any number does.
    static int inner_count(int trips) {
        for (int inner = most_repeats; inner > 15; --inner)
            if (trips % inner == 0) return inner;
        const int outer = (trips + most_repeats - 1) / most_repeats;
        return (trips + outer - 1) / outer;
    }

    ValueId append(std::vector<Instruction>& body, Op op, ir::Type type,
                   std::vector<ValueId> operands) {
        body.push_back(passes::make_instruction(module_, op, type, operands, origin_));
        return body.back().result();
    }
    ValueId append_int(std::vector<Instruction>& body, int value) {
        body.push_back(passes::make_int_constant(module_, value, origin_));
        return body.back().result();
    }
    static Instruction terminator(Op op, std::vector<ValueId> operands, const ir::Origin& origin) {
        Instruction result;
        result.op = op;
        result.operands = std::move(operands);
        result.origin = origin;
        return result;
    }

    void split(Instruction loop, std::vector<Instruction>& body) {
        origin_ = loop.origin;
        const int trips = loop.loop.trip_count, inner = inner_count(trips),
                  outer = (trips + inner - 1) / inner;
        std::vector<ValueId> initial = loop.operands;
        body.push_back(passes::make_constant(module_, ir::bool1, {}, origin_));
        initial.push_back(body.back().result());

        Instruction around;
        around.op = Op::Loop;
        around.origin = origin_;
        around.loop = loop.loop;
        around.loop.trip_count = outer;
        around.operands = initial;
        around.results = loop.results;
        around.results.push_back(module_.add_value(ir::bool1));
        ir::Region region;
        region.parameters.push_back(module_.add_value(ir::int1));
        std::vector<ValueId> carried;
        for (const ValueId value : initial) {
            region.parameters.push_back(module_.add_value(module_.type(value)));
            carried.push_back(region.parameters.back());
        }

        loop.loop.trip_count = inner;
        loop.loop.name += "_part";
        loop.operands = carried;
        loop.results.clear();
        for (const ValueId value : carried)
            loop.results.push_back(module_.add_value(module_.type(value)));
        count_within(loop.regions[0], region.parameters[0], inner,
                     inner * outer > trips ? trips : 0);
        std::vector<ValueId> exit = loop.results;
        exit.insert(exit.begin(), loop.results.back());
        const std::vector<ValueId> results = loop.results;
        region.body.push_back(std::move(loop));
        region.body.push_back(terminator(Op::BreakIf, exit, origin_));
        region.body.push_back(terminator(Op::Yield, results, origin_));
        around.regions.push_back(std::move(region));
        if (outer > most_repeats)
            split(std::move(around), body);
        else
            body.push_back(std::move(around));
    }

    // The old index from both new ones; exits and the end carry whether the loop was left. `limit`:
    // leave at this iteration; 0: the counts are exact.
    void count_within(ir::Region& region, ValueId outer_index, int inner, int limit) {
        std::vector<Instruction> body;
        const ValueId old = region.parameters[0];
        region.parameters[0] = module_.add_value(ir::int1);
        region.parameters.push_back(module_.add_value(ir::bool1));
        const ValueId whole =
            append(body, Op::Mul, ir::int1, {outer_index, append_int(body, inner)});
        Instruction index = passes::make_instruction(
            module_, Op::Add, ir::int1, std::vector<ValueId>{whole, region.parameters[0]}, origin_);
        index.results = {old};
        body.push_back(std::move(index));
        body.push_back(passes::make_constant(module_, ir::bool1, {}, origin_));
        ValueId left = body.back().result();
        if (limit > 0) {
            left = append(body, Op::GreaterEqual, ir::bool1, {old, append_int(body, limit)});
            std::vector<ValueId> values = {left};
            values.insert(values.end(), region.parameters.begin() + 1, region.parameters.end() - 1);
            values.push_back(left);
            body.push_back(terminator(Op::BreakIf, values, origin_));
        }
        for (Instruction& it : region.body) {
            if (it.op == Op::BreakIf) left = it.operands[0];
            if (it.op == Op::BreakIf || it.op == Op::Yield) it.operands.push_back(left);
            body.push_back(std::move(it));
        }
        region.body = std::move(body);
    }

    ir::Module& module_;
    ir::Origin origin_;
};

}  // namespace

void split_long_loops(ir::Module& module) {
    Splitter(module).visit(module.body);
    passes::compact_values(module);
}

}  // namespace intaglio::d3d9
