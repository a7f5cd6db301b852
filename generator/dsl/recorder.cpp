// Recording: origins, variables carried by loops and ifs, and the first error.
#include "generator/dsl/recorder.h"

#include <algorithm>
#include <cassert>

#include "generator/base/nearest.h"

namespace intaglio::dsl {
namespace {

thread_local Recorder* current_recorder = nullptr;

}  // namespace

Recorder::Recorder(ir::Module& module) : builder_(module), outer_(current_recorder) {
    current_recorder = this;
}

Recorder::~Recorder() { current_recorder = outer_; }

Recorder& Recorder::current() {
    assert(current_recorder && "a DSL value was made outside a recording");
    return *current_recorder;
}

std::string Recorder::relative_path(std::string_view path) {
    // The build passes absolute or relative paths as it likes; emitted text must not depend on
    // where a checkout lies.
    for (std::string_view root : {"templates/", "generator/", "examples/", "tests/"}) {
        const std::size_t at = path.rfind(root);
        if (at != std::string_view::npos && (at == 0 || path[at - 1] == '/'))
            return std::string(path.substr(at));
    }
    const std::size_t slash = path.rfind('/');
    return std::string(slash == std::string_view::npos ? path : path.substr(slash + 1));
}

int Recorder::file_index(std::string_view path) {
    const std::string relative = relative_path(path);
    std::vector<std::string>& files = module().files;
    const auto found = std::find(files.begin(), files.end(), relative);
    if (found != files.end()) return static_cast<int>(found - files.begin());
    files.push_back(relative);
    return static_cast<int>(files.size()) - 1;
}

void Recorder::locate(Place place) {
    const int file = file_index(place.file);
    std::vector<ir::Instruction>& body = builder_.current_region().body;
    for (auto instruction = body.rbegin();
         instruction != body.rend() && instruction->origin.line == 0; ++instruction) {
        instruction->origin.file = file;
        instruction->origin.line = place.line;
    }
}

void Recorder::name_value(ir::ValueId value, std::string_view name) {
    module().values[ir::index_of(value)].name = name;
}

int Recorder::enter_step(std::string_view name, std::string_view comment) {
    const int outer = step_;
    module().steps.push_back({std::string(name), std::string(comment)});
    step_ = static_cast<int>(module().steps.size()) - 1;
    builder_.set_origin({-1, 0, step_});
    return outer;
}

void Recorder::leave_step(int outer) {
    step_ = outer;
    builder_.set_origin({-1, 0, step_});
}

void Recorder::add_variable(VariableSlot* variable) { variables_.push_back(variable); }

void Recorder::remove_variable(VariableSlot* variable) { std::erase(variables_, variable); }

std::vector<ir::ValueId> Recorder::current_values(
    const std::vector<VariableSlot*>& variables) const {
    std::vector<ir::ValueId> values;
    for (const VariableSlot* variable : variables) values.push_back(*variable->current);
    return values;
}

void Recorder::rebind(const std::vector<VariableSlot*>& variables,
                      const std::vector<ir::ValueId>& values) {
    for (std::size_t i = 0; i < variables.size(); ++i) *variables[i]->current = values[i];
}

void Recorder::name_all(const std::vector<VariableSlot*>& variables,
                        const std::vector<ir::ValueId>& values) {
    for (std::size_t i = 0; i < variables.size(); ++i) name_value(values[i], variables[i]->name);
}

ir::ValueId Recorder::begin_loop(const Loop& loop, ir::LoopInfo loop_info, Place place) {
    locate(place);
    if (const auto directive = directives_.find(&loop); directive != directives_.end()) {
        loop_info.form = directive->second.form;
        loop_info.closed_form = directive->second.closed_form;
    }
    if (const auto override_ = overrides_.find(loop_info.name); override_ != overrides_.end())
        loop_info.form = override_->second;
    loop_names_.push_back(loop_info.name);
    Scope scope{&loop, place, variables_, current_values(variables_)};
    const ir::Builder::LoopScope opened = builder_.begin_loop(std::move(loop_info), scope.before);
    name_value(opened.index, "i");
    name_all(scope.variables, opened.carried);
    rebind(scope.variables, opened.carried);
    scopes_.push_back(std::move(scope));
    return opened.index;
}

void Recorder::break_if(const Loop& loop, ir::ValueId condition, Place place) {
    if (scopes_.empty() || scopes_.back().loop != &loop) {
        Diagnostic error = input_error("until-outside-loop",
                                       "until() stands outside the body of its loop, or inside an "
                                       "If within it; call it at the top level of the loop's body",
                                       relative_path(place.file), place.line);
        fail(std::move(error));
        return;
    }
    builder_.break_if(condition, current_values(scopes_.back().variables));
    locate(place);
}

void Recorder::end_loop(const Loop& loop) {
    if (scopes_.empty() || scopes_.back().loop != &loop) {
        fail(input_error("unclosed-scope",
                         "a loop ended while another loop or an If inside it was still open"));
        return;
    }
    const Scope scope = std::move(scopes_.back());
    scopes_.pop_back();
    const std::vector<ir::ValueId> results = builder_.end_loop(current_values(scope.variables));
    locate(scope.place);
    name_all(scope.variables, results);
    rebind(scope.variables, results);
}

void Recorder::begin_if(ir::ValueId condition) {
    scopes_.push_back({nullptr, {}, variables_, current_values(variables_)});
    builder_.begin_if(condition);
}

void Recorder::begin_else() {
    const Scope& scope = scopes_.back();
    builder_.begin_else(current_values(scope.variables));
    rebind(scope.variables, scope.before);
}

void Recorder::end_if() {
    const Scope scope = std::move(scopes_.back());
    scopes_.pop_back();
    const std::vector<ir::ValueId> results = builder_.end_if(current_values(scope.variables));
    name_all(scope.variables, results);
    rebind(scope.variables, results);
}

void Recorder::set_loop_form(const Loop& loop, ir::LoopForm form, bool closed_form) {
    directives_[&loop] = {form, closed_form};
}

void Recorder::fail(Diagnostic error) {
    if (!error_) error_ = std::move(error);
}

Status Recorder::finish(const std::vector<ir::ValueId>& outputs) {
    if (!scopes_.empty())
        fail(input_error(
            "unclosed-scope",
            "a recorded loop was left by a C++ break or return; use until() to leave it early"));
    for (const auto& [name, form] : overrides_)
        if (!absent_loops_ &&
            std::find(loop_names_.begin(), loop_names_.end(), name) == loop_names_.end())
            fail(input_error("unknown-loop", unknown_name_sentence("loop", name, loop_names_)));
    if (error_) return *error_;
    builder_.finish(outputs);
    return Done{};
}

}  // namespace intaglio::dsl
