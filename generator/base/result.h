// Errors are values with a sentence for the user.  A Diagnostic says where, what and why; a Result
// holds either a value or one Diagnostic.  Nothing here throws; assertions are for our own bugs.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace intaglio {

// Whose fault it is decides the exit code: bad input or usage 2, our own failure 3 (docs: exit
// codes).
enum class Fault { Input, Internal };

struct Diagnostic {
    std::string
        code;  // short and stable, e.g. "unknown-target"; printed in brackets after the sentence
    std::string message;  // one sentence, no full stop, no line break
    std::string file;     // empty: nothing to point at
    int line = 0;         // 1-based; 0: unknown
    int column = 0;       // 1-based; 0: unknown
    std::vector<std::string>
        notes;  // further sentences, each printed on a line of its own ("hint: ...")
    Fault fault = Fault::Input;
};

// "file:line:col: error: sentence [code]", then the notes, each indented by two spaces; no final
// line break.
std::string to_string(const Diagnostic& diagnostic);

// An error about the user's input, without a place.
Diagnostic input_error(std::string code, std::string message);
// An error about the user's input, in a file.
Diagnostic input_error(std::string code, std::string message, std::string file, int line = 0,
                       int column = 0);
// Something that should not have happened, whatever the input.
Diagnostic internal_error(std::string code, std::string message);

template <typename T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Diagnostic error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    T& value() & {
        assert(ok());
        return std::get<0>(state_);
    }
    const T& value() const& {
        assert(ok());
        return std::get<0>(state_);
    }
    T&& value() && {
        assert(ok());
        return std::get<0>(std::move(state_));
    }
    const Diagnostic& error() const {
        assert(!ok());
        return std::get<1>(state_);
    }

    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

  private:
    std::variant<T, Diagnostic> state_;
};

// The result of an action that yields nothing.
struct Done {};
using Status = Result<Done>;

}  // namespace intaglio
