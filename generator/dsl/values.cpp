// Recording of single operations.
#include "generator/dsl/values.h"

namespace intaglio::dsl {

ir::ValueId record(ir::Op op, std::initializer_list<ir::ValueId> operands) {
    return Recorder::current().builder().emit(op, operands);
}

ir::ValueId record_splat(ir::ValueId scalar, int width) {
    constexpr std::string_view repeated = "xxxx";
    return Recorder::current().builder().swizzle(
        scalar, repeated.substr(0, static_cast<std::size_t>(width)));
}

ir::ValueId record_wide(ir::Op op, ir::ValueId left, ir::ValueId right) {
    const ir::Module& module = Recorder::current().module();
    const int left_width = module.type(left).width;
    const int right_width = module.type(right).width;
    if (left_width < right_width) left = record_splat(left, right_width);
    if (right_width < left_width) right = record_splat(right, left_width);
    return record(op, {left, right});
}

ir::ValueId record_swizzle(ir::ValueId value, std::string_view letters) {
    return Recorder::current().builder().swizzle(value, letters);
}

ir::ValueId record_compose(std::initializer_list<ir::ValueId> operands) {
    return Recorder::current().builder().compose({operands.begin(), operands.size()});
}

ir::ValueId record_constant(float value) { return Recorder::current().builder().constant(value); }
ir::ValueId record_constant(int value) { return Recorder::current().builder().constant(value); }
ir::ValueId record_constant(bool value) { return Recorder::current().builder().constant(value); }

float1 ratio(float1 a, float1 b) { return saturate(a / max(b, float1(tiny))); }

}  // namespace intaglio::dsl
