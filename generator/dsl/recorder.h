// The recorder: turns DSL expressions into IR while a technique's C++ body runs.  One recorder is
// current per thread; the value types below it are thin handles.  Techniques never see this class.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/place.h"
#include "generator/base/result.h"
#include "generator/ir/builder.h"

namespace intaglio::dsl {

class Loop;

// A C++ variable of type var<T>: loops and ifs carry every live one that they change.
struct VariableSlot {
    ir::ValueId* current;
    std::string name;
};

class Recorder {
  public:
    // Records into `module` until destroyed; recorders nest like a stack.
    explicit Recorder(ir::Module& module);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    // The current recorder of this thread; asserts if there is none (a DSL value was made outside a
    // recording).
    static Recorder& current();

    ir::Builder& builder() { return builder_; }
    ir::Module& module() { return builder_.module(); }

    // Gives every instruction appended since the last call this line: operators have no place of
    // their own and take that of the next named call, which stands in the same statement.
    void locate(Place place);
    // Where the C++ files' paths are cut so that they are relative to a project's root.
    static std::string relative_path(std::string_view path);

    void name_value(ir::ValueId value, std::string_view name);

    // Steps nest: leaving one returns to the outer.
    int enter_step(std::string_view name, std::string_view comment);
    void leave_step(int outer);

    void add_variable(VariableSlot* variable);
    void remove_variable(VariableSlot* variable);

    ir::ValueId begin_loop(const Loop& loop, ir::LoopInfo info, Place place);
    void break_if(const Loop& loop, ir::ValueId condition, Place place);
    void end_loop(const Loop& loop);

    void begin_if(ir::ValueId condition);
    void begin_else();
    void end_if();

    // What the schedule says of a loop, by identity; read when the loop is recorded.
    void set_loop_form(const Loop& loop, ir::LoopForm form, bool closed_form);

    // A caller's own choice for every loop of this name, above what the schedule says.
    void override_loop_form(const std::string& loop_name, ir::LoopForm form) {
        overrides_[loop_name] = form;
    }
    // Whoever records one pass of several may give choices for loops of the others.
    void allow_absent_loops() { absent_loops_ = true; }

    // Closes the module with its output values, and gives the first error of the recording, if any.
    Status finish(const std::vector<ir::ValueId>& outputs);
    void fail(Diagnostic error);

  private:
    struct Scope {                   // an open loop or if
        const Loop* loop = nullptr;  // nullptr: an if
        Place place;
        std::vector<VariableSlot*> variables;
        std::vector<ir::ValueId> before;
    };
    struct Directive {
        ir::LoopForm form;
        bool closed_form;
    };
    std::vector<ir::ValueId> current_values(const std::vector<VariableSlot*>& variables) const;
    void rebind(const std::vector<VariableSlot*>& variables,
                const std::vector<ir::ValueId>& values);
    void name_all(const std::vector<VariableSlot*>& variables,
                  const std::vector<ir::ValueId>& values);
    int file_index(std::string_view path);

    ir::Builder builder_;
    Recorder* outer_;
    int step_ = -1;
    std::vector<VariableSlot*> variables_;
    std::vector<Scope> scopes_;
    std::map<const Loop*, Directive> directives_;
    std::map<std::string, ir::LoopForm> overrides_;
    std::vector<std::string> loop_names_;
    bool absent_loops_ = false;
    std::optional<Diagnostic> error_;
};

}  // namespace intaglio::dsl
