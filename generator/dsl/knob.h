// Knobs: named numbers of a technique, known while generating.  Another value is another variant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::dsl {

struct at_least {
    double value;
};
struct at_most {
    double value;
};

// What is common to knobs of any type: name, range, default and present value.
class KnobBase {
  public:
    KnobBase(const KnobBase&) = delete;
    KnobBase& operator=(const KnobBase&) = delete;

    const std::string& name() const { return name_; }
    const std::string& comment() const { return comment_; }
    double least() const { return least_; }
    double most() const { return most_; }
    double initial() const { return initial_; }
    double number() const { return number_; }
    bool whole() const { return whole_; }
    // "taps = 8"
    std::string setting() const;

    // Sets the knob from what a user wrote; a sentence if it is no number, not whole where it must
    // be, or out of range.
    Status set(std::string_view text);
    Status set(double value);

  protected:
    KnobBase(std::string name, double initial, at_least least, at_most most, bool whole,
             std::string comment)
        : name_(std::move(name)),
          comment_(std::move(comment)),
          initial_(initial),
          number_(initial),
          least_(least.value),
          most_(most.value),
          whole_(whole) {}
    ~KnobBase() = default;

  private:
    std::string name_, comment_;
    double initial_, number_, least_, most_;
    bool whole_;
};

// The knobs of one technique, in order of declaration.
class KnobOwner {
  public:
    const std::vector<KnobBase*>& knobs() const { return knobs_; }

  protected:
    KnobOwner() = default;
    ~KnobOwner() = default;

  private:
    template <typename T>
    friend class Knob;
    std::vector<KnobBase*> knobs_;
};

template <typename T>
class Knob : public KnobBase {
    static_assert(std::is_same_v<T, int> || std::is_same_v<T, float>,
                  "a knob is an int or a float");

  public:
    // `comment`: what it means, with its unit.
    Knob(KnobOwner* owner, std::string name, T initial, at_least least, at_most most,
         std::string comment)
        : KnobBase(std::move(name), initial, least, most, std::is_same_v<T, int>,
                   std::move(comment)) {
        owner->knobs_.push_back(this);
    }
    T value() const { return static_cast<T>(number()); }
    operator T() const { return value(); }
};

}  // namespace intaglio::dsl
