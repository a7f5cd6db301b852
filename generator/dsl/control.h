// Recorded control flow: variables, loops with early exit, and ifs.
#pragma once

#include <functional>
#include <string>

#include "generator/dsl/knob.h"
#include "generator/dsl/values.h"

namespace intaglio::dsl {

// A value together with the C++ line that made it; converting to it is how assignments learn their
// place.
template <typename T>
struct Located {
    template <typename U>
    requires std::convertible_to<U, T> Located(const U& from, Place at = Place::here())
        : value(from), place(at) {}
    T value;
    Place place;
};

// A variable: assignment is recorded, loops and ifs carry it.  It reads as a T.  It cannot be
// copied, because a copy would look like a second variable and be none; `float1 now = t;` takes its
// present value.
template <typename T>
class var : public T {
  public:
    var(std::string_view name, T initial, Place place = Place::here())
        : T(initial), slot_{&this->id_, std::string(name)} {
        Recorder::current().locate(place);
        Recorder::current().add_variable(&slot_);
    }
    ~var() { Recorder::current().remove_variable(&slot_); }
    var(const var&) = delete;

    var& operator=(const Located<T>& from) {
        Recorder::current().locate(from.place);
        this->id_ = from.value.id();
        return *this;
    }
    var& operator=(const var& from) {
        this->id_ = from.id_;
        return *this;
    }

  private:
    VariableSlot slot_;
};

template <int N>
constexpr int width_of(const var<Float<N>>*) {
    return N;
}

// A loop of at most `count` iterations, named so that a schedule can speak of it.
//     for (int1 i : march) { march.until(condition); ... }
// records the body once.  What becomes of it (a loop, unrolled) is the schedule's business.
class Loop {
  public:
    Loop(std::string name, const Knob<int>& count) : name_(std::move(name)), count_(&count) {}
    // One iteration fewer or more than the knob says: `offset` is added to it.
    Loop(std::string name, const Knob<int>& count, int offset)
        : name_(std::move(name)), count_(&count), offset_(offset) {}
    Loop(const Loop&) = delete;
    Loop& operator=(const Loop&) = delete;

    const std::string& name() const { return name_; }
    int trip_count() const { return count_->value() + offset_; }

    // Leaves the loop if `condition` holds; the variables keep the values they have here.
    void until(bool1 condition, Place place = Place::here()) const {
        Recorder::current().break_if(*this, condition.id(), place);
    }

    struct End {};
    class Iterator {
      public:
        Iterator(const Loop& loop, Place place)
            : loop_(&loop),
              index_(Recorder::current().begin_loop(loop, {loop.name(), loop.trip_count(), {}, {}},
                                                    place)) {}
        int1 operator*() const { return int1::of(index_); }
        bool operator!=(End) const { return open_; }
        void operator++() {
            Recorder::current().end_loop(*loop_);
            open_ = false;
        }

      private:
        const Loop* loop_;
        ir::ValueId index_;
        bool open_ = true;
    };
    Iterator begin(Place place = Place::here()) const { return {*this, place}; }
    End end() const { return {}; }

  private:
    std::string name_;
    const Knob<int>* count_;
    int offset_ = 0;
};

// Runs one of two bodies; the variables they assign are carried out.
//     If(light.z() > 0.0f, [&] { ... }, [&] { ... });
void If(bool1 condition, const std::function<void()>& then_body,
        const std::function<void()>& else_body = {}, Place place = Place::here());

// A part of the technique's work: a comment in the emitted text, and the heading its cost is
// charged to.
//     { Step step("march", "March the view ray down through the relief."); ... }
class Step {
  public:
    Step(std::string_view name, std::string_view comment)
        : outer_(Recorder::current().enter_step(name, comment)) {}
    ~Step() { Recorder::current().leave_step(outer_); }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

  private:
    int outer_;
};

}  // namespace intaglio::dsl
