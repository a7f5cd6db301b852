// The recorded value types: float1..4, int1, bool1.  The staging rule is the spelling: `float` and
// `int` are known while generating, `float1` and `int1` are recorded and run on the GPU.
//
// A double literal, an `if` on a recorded value, or copying a var does not compile: each would hide
// at which time something happens.
#pragma once

#include <concepts>
#include <string_view>

#include "generator/base/place.h"
#include "generator/dsl/recorder.h"

namespace intaglio::dsl {

template <int N>
class Float;
class int1;
using float1 = Float<1>;
using float2 = Float<2>;
using float3 = Float<3>;
using float4 = Float<4>;

// Something that converts to a recorded float vector, with its width: Float<N>, var<Float<N>>,
// float, int, int1.
template <int N>
constexpr int width_of(const Float<N>*) {
    return N;
}
constexpr int width_of(const float*) { return 1; }
constexpr int width_of(const int*) { return 1; }
constexpr int width_of(const int1*) { return 1; }
template <typename T>
concept Component = requires(const T* pointer) {
    width_of(pointer);
};

// Appends an op over recorded operands and gives its value.
ir::ValueId record(ir::Op op, std::initializer_list<ir::ValueId> operands);
// Two operands of one op; a scalar meeting a vector is repeated.
ir::ValueId record_wide(ir::Op op, ir::ValueId left, ir::ValueId right);
ir::ValueId record_swizzle(ir::ValueId value, std::string_view letters);
ir::ValueId record_splat(ir::ValueId scalar, int width);
ir::ValueId record_compose(std::initializer_list<ir::ValueId> operands);
ir::ValueId record_constant(float value);
ir::ValueId record_constant(int value);
ir::ValueId record_constant(bool value);

// A recorded bool.  && || ! are recorded and evaluate both sides.
class bool1 {
  public:
    template <std::same_as<bool> B>
    bool1(B value) : id_(record_constant(value)) {}
    static bool1 of(ir::ValueId id) { return bool1(id); }
    // A recorded value has no truth while generating: use If, select or Loop::until.
    explicit operator bool() const = delete;
    ir::ValueId id() const { return id_; }

    friend bool1 operator&&(bool1 a, bool1 b) { return of(record(ir::Op::And, {a.id_, b.id_})); }
    friend bool1 operator||(bool1 a, bool1 b) { return of(record(ir::Op::Or, {a.id_, b.id_})); }
    friend bool1 operator!(bool1 a) { return of(record(ir::Op::Not, {a.id_})); }

  protected:
    explicit bool1(ir::ValueId id) : id_(id) {}
    ir::ValueId id_;
};

// A recorded int: loop indices and counts.
class int1 {
  public:
    template <std::same_as<int> I>
    int1(I value) : id_(record_constant(value)) {}
    static int1 of(ir::ValueId id) { return int1(id); }
    explicit operator bool() const = delete;
    ir::ValueId id() const { return id_; }

    friend int1 operator+(int1 a, int1 b) { return of(record(ir::Op::Add, {a.id_, b.id_})); }
    friend int1 operator-(int1 a, int1 b) { return of(record(ir::Op::Sub, {a.id_, b.id_})); }
    friend int1 operator*(int1 a, int1 b) { return of(record(ir::Op::Mul, {a.id_, b.id_})); }
    friend bool1 operator<(int1 a, int1 b) {
        return bool1::of(record(ir::Op::Less, {a.id_, b.id_}));
    }
    friend bool1 operator<=(int1 a, int1 b) {
        return bool1::of(record(ir::Op::LessEqual, {a.id_, b.id_}));
    }
    friend bool1 operator>(int1 a, int1 b) {
        return bool1::of(record(ir::Op::Greater, {a.id_, b.id_}));
    }
    friend bool1 operator>=(int1 a, int1 b) {
        return bool1::of(record(ir::Op::GreaterEqual, {a.id_, b.id_}));
    }
    friend bool1 operator==(int1 a, int1 b) {
        return bool1::of(record(ir::Op::Equal, {a.id_, b.id_}));
    }

  protected:
    explicit int1(ir::ValueId id) : id_(id) {}
    ir::ValueId id_;
};

// A recorded vector of N floats; float1 is the scalar.
template <int N>
class Float {
  public:
    // Literals: 0.5f and 2 are scalars; 0.5 is a double and refused.
    template <std::same_as<float> F>
    Float(F value) requires(N == 1) : id_(record_constant(value)) {}
    template <std::same_as<int> I>
    Float(I value) requires(N == 1) : id_(record_constant(static_cast<float>(value))) {}
    template <std::same_as<double> D>
    Float(D value) = delete;
    Float(int1 value) requires(N == 1) : id_(record(ir::Op::ToFloat, {value.id()})) {}
    // float3(0.5f): the scalar repeated.
    template <Component Scalar>
    requires(N > 1 &&
             width_of(static_cast<const Scalar*>(nullptr)) == 1) explicit Float(const Scalar& value)
        : id_(record_splat(component(value), N)) {}
    // float4(rgb, 1.0f): components in order.
    template <Component... Parts>
    requires(sizeof...(Parts) > 1 && (width_of(static_cast<const Parts*>(nullptr)) + ...) == N)
        Float(const Parts&... parts)
        : id_(record_compose({component(parts)...})) {}

    static Float of(ir::ValueId id) { return Float(id); }
    explicit operator bool() const = delete;
    ir::ValueId id() const { return id_; }

    float1 x() const;
    float1 y() const requires(N >= 2);
    float1 z() const requires(N >= 3);
    float1 w() const requires(N >= 4);
    float2 xy() const requires(N >= 2);
    float2 yx() const requires(N >= 2);
    float2 zw() const requires(N >= 4);
    float3 xyz() const requires(N >= 3);

    friend Float operator-(Float a) { return of(record(ir::Op::Neg, {a.id_})); }
    friend Float operator+(Float a, Float b) { return of(record(ir::Op::Add, {a.id_, b.id_})); }
    friend Float operator-(Float a, Float b) { return of(record(ir::Op::Sub, {a.id_, b.id_})); }
    friend Float operator*(Float a, Float b) { return of(record(ir::Op::Mul, {a.id_, b.id_})); }
    friend Float operator/(Float a, Float b) { return of(record(ir::Op::Div, {a.id_, b.id_})); }
    friend Float operator+(Float a, float1 b) requires(N > 1) {
        return of(record_wide(ir::Op::Add, a.id_, b.id()));
    }
    friend Float operator-(Float a, float1 b) requires(N > 1) {
        return of(record_wide(ir::Op::Sub, a.id_, b.id()));
    }
    friend Float operator*(Float a, float1 b) requires(N > 1) {
        return of(record_wide(ir::Op::Mul, a.id_, b.id()));
    }
    friend Float operator/(Float a, float1 b) requires(N > 1) {
        return of(record_wide(ir::Op::Div, a.id_, b.id()));
    }

    friend bool1 operator<(Float a, Float b) requires(N == 1) {
        return compare(ir::Op::Less, a, b);
    }
    friend bool1 operator<=(Float a, Float b) requires(N == 1) {
        return compare(ir::Op::LessEqual, a, b);
    }
    friend bool1 operator>(Float a, Float b) requires(N == 1) {
        return compare(ir::Op::Greater, a, b);
    }
    friend bool1 operator>=(Float a, Float b) requires(N == 1) {
        return compare(ir::Op::GreaterEqual, a, b);
    }
    friend bool1 operator==(Float a, Float b) requires(N == 1) {
        return compare(ir::Op::Equal, a, b);
    }
    friend bool1 operator!=(Float a, Float b) requires(N == 1) {
        return compare(ir::Op::NotEqual, a, b);
    }

    friend Float abs(Float a) { return of(record(ir::Op::Abs, {a.id_})); }
    friend Float min(Float a, Float b) { return of(record(ir::Op::Min, {a.id_, b.id_})); }
    friend Float max(Float a, Float b) { return of(record(ir::Op::Max, {a.id_, b.id_})); }
    friend Float min(Float a, float1 b) requires(N > 1) {
        return of(record_wide(ir::Op::Min, a.id_, b.id()));
    }
    friend Float max(Float a, float1 b) requires(N > 1) {
        return of(record_wide(ir::Op::Max, a.id_, b.id()));
    }
    friend Float saturate(Float a) { return of(record(ir::Op::Saturate, {a.id_})); }
    friend Float floor(Float a) { return of(record(ir::Op::Floor, {a.id_})); }
    friend Float frac(Float a) { return of(record(ir::Op::Frac, {a.id_})); }
    friend Float sqrt(Float a) { return of(record(ir::Op::Sqrt, {a.id_})); }
    friend Float rsqrt(Float a) { return of(record(ir::Op::Rsqrt, {a.id_})); }
    friend Float exp2(Float a) { return of(record(ir::Op::Exp2, {a.id_})); }
    friend Float log2(Float a) { return of(record(ir::Op::Log2, {a.id_})); }
    friend Float pow(Float a, Float b) { return of(record(ir::Op::Pow, {a.id_, b.id_})); }
    friend Float sin(Float a) { return of(record(ir::Op::Sin, {a.id_})); }
    friend Float cos(Float a) { return of(record(ir::Op::Cos, {a.id_})); }
    // a at c = 0, b at c = 1.
    friend Float lerp(Float a, Float b, Float c) {
        return of(record(ir::Op::Lerp, {a.id_, b.id_, c.id_}));
    }
    friend Float lerp(Float a, Float b, float1 c) requires(N > 1) {
        return of(record(ir::Op::Lerp, {a.id_, b.id_, record_splat(c.id(), N)}));
    }
    friend float1 dot(Float a, Float b) requires(N > 1) {
        return float1::of(record(ir::Op::Dot, {a.id_, b.id_}));
    }
    friend Float cross(Float a, Float b) requires(N == 3) {
        return of(record(ir::Op::Cross, {a.id_, b.id_}));
    }
    // Differences to the neighbouring pixel; outside loops and ifs only.
    friend Float ddx(Float a) { return of(record(ir::Op::Ddx, {a.id_})); }
    friend Float ddy(Float a) { return of(record(ir::Op::Ddy, {a.id_})); }
    // b where a holds, else c; both are evaluated.
    friend Float select(bool1 a, Float b, Float c) {
        return of(record(ir::Op::Select, {a.id(), b.id_, c.id_}));
    }

  protected:
    explicit Float(ir::ValueId id) : id_(id) {}
    static bool1 compare(ir::Op op, Float a, Float b) {
        return bool1::of(record(op, {a.id_, b.id_}));
    }
    static ir::ValueId component(float1 part);
    template <int M>
    requires(M > 1) static ir::ValueId component(Float<M> part) { return part.id(); }

    ir::ValueId id_;
};

template <int N>
ir::ValueId Float<N>::component(float1 part) {
    return part.id();
}
template <int N>
float1 Float<N>::x() const {
    return float1::of(record_swizzle(id_, "x"));
}
template <int N>
float1 Float<N>::y() const requires(N >= 2) {
    return float1::of(record_swizzle(id_, "y"));
}
template <int N>
float1 Float<N>::z() const requires(N >= 3) {
    return float1::of(record_swizzle(id_, "z"));
}
template <int N>
float1 Float<N>::w() const requires(N >= 4) {
    return float1::of(record_swizzle(id_, "w"));
}
template <int N>
float2 Float<N>::xy() const requires(N >= 2) {
    return float2::of(record_swizzle(id_, "xy"));
}
template <int N>
float2 Float<N>::yx() const requires(N >= 2) {
    return float2::of(record_swizzle(id_, "yx"));
}
template <int N>
float2 Float<N>::zw() const requires(N >= 4) {
    return float2::of(record_swizzle(id_, "zw"));
}
template <int N>
float3 Float<N>::xyz() const requires(N >= 3) {
    return float3::of(record_swizzle(id_, "xyz"));
}

// A scalar on the left of a vector, and an int meeting a float literal: `2.0f * v`, `(i + 1) *
// 0.125f`.
template <int N>
requires(N > 1) Float<N>
operator*(float1 a, Float<N> b) { return Float<N>::of(record_wide(ir::Op::Mul, a.id(), b.id())); }
template <int N>
requires(N > 1) Float<N>
operator+(float1 a, Float<N> b) { return Float<N>::of(record_wide(ir::Op::Add, a.id(), b.id())); }
template <int N>
requires(N > 1) Float<N>
operator-(float1 a, Float<N> b) { return Float<N>::of(record_wide(ir::Op::Sub, a.id(), b.id())); }
template <std::same_as<float> F>
float1 operator*(int1 a, F b) {
    return float1(a) * float1(b);
}
template <std::same_as<float> F>
float1 operator+(int1 a, F b) {
    return float1(a) + float1(b);
}

// Guards.  The least value a divisor or squared length is raised to: large enough for fp24 (whose
// least normal is 2^-62), small enough to change no vector longer than 1e-9.
constexpr float tiny = 1e-18f;

// |v|, and v / |v| with 0 for the zero vector (a bare normalize of 0 is NaN on most devices).
template <int N>
float1 length(Float<N> v) {
    return sqrt(dot(v, v));
}
template <int N>
Float<N> normalize(Float<N> v) {
    return v * rsqrt(max(dot(v, v), float1(tiny)));
}

// a / b within [0, 1] for 0 <= a and 0 <= b; 0 where both are 0.
float1 ratio(float1 a, float1 b);

// Gives a value the name it has in the emitted text, and the statement its C++ line.
template <typename T>
T let(std::string_view name, T value, Place place = Place::here()) {
    Recorder& recorder = Recorder::current();
    recorder.locate(place);
    recorder.name_value(value.id(), name);
    return value;
}

}  // namespace intaglio::dsl
