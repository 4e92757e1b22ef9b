// Numbers, masks, directions and random numbers, as many at once as a register holds, by Highway:
// included once for each instruction set by the files that are compiled for each
// (foreach_target.h), never elsewhere.
//
// One of the places of a register is an element here. Highway calls it a lane, which is an absorber
// of the film elsewhere. With AVX-512 and AVX2 every operation rounds as IEEE 754 says and fma()
// fuses, so that an element's result does not depend on how many there are.

#include <hwy/highway.h>
// After highway.h:
#include <hwy/contrib/math/math-inl.h>

#include "renderer/base/batch.h"

#if defined(TRANSLUCUBE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TRANSLUCUBE_SIMD_H
#undef TRANSLUCUBE_SIMD_H
#else
#define TRANSLUCUBE_SIMD_H
#endif

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using DU = hn::RebindToUnsigned<D>;
using DI = hn::RebindToSigned<D>;

/// Elements of a register: loops over a batch take so many at once.
constexpr std::size_t at_once = hn::MaxLanes(D());
constexpr float pi_f = 3.14159265f;

// ---- masks

using Mask = hn::Mask<D>;

HWY_INLINE Mask both(Mask a, Mask b) { return hn::And(a, b); }
HWY_INLINE Mask either(Mask a, Mask b) { return hn::Or(a, b); }
HWY_INLINE Mask except(Mask a, Mask b) { return hn::AndNot(b, a); }
HWY_INLINE Mask complement(Mask a) { return hn::Not(a); }
/// The first n elements, or all that there are.
HWY_INLINE Mask first(std::size_t n) { return hn::FirstN(D(), n); }
HWY_INLINE std::size_t count(Mask a) { return hn::CountTrue(D(), a); }
HWY_INLINE bool all(Mask a) { return hn::AllTrue(D(), a); }
HWY_INLINE bool none(Mask a) { return hn::AllFalse(D(), a); }

// ---- numbers

/// A number in each element.
struct Real {
  hn::Vec<D> v;

  Real() = default;
  HWY_INLINE Real(hn::Vec<D> elements) : v(elements) {}
  HWY_INLINE Real(float same) : v(hn::Set(D(), same)) {}

  friend HWY_INLINE Real operator+(Real a, Real b) { return hn::Add(a.v, b.v); }
  friend HWY_INLINE Real operator-(Real a, Real b) { return hn::Sub(a.v, b.v); }
  friend HWY_INLINE Real operator-(Real a) { return hn::Neg(a.v); }
  friend HWY_INLINE Real operator*(Real a, Real b) { return hn::Mul(a.v, b.v); }
  friend HWY_INLINE Real operator/(Real a, Real b) { return hn::Div(a.v, b.v); }
  friend HWY_INLINE Mask operator<(Real a, Real b) { return hn::Lt(a.v, b.v); }
  friend HWY_INLINE Mask operator<=(Real a, Real b) { return hn::Le(a.v, b.v); }
  friend HWY_INLINE Mask operator>(Real a, Real b) { return hn::Gt(a.v, b.v); }
  friend HWY_INLINE Mask operator>=(Real a, Real b) { return hn::Ge(a.v, b.v); }
  friend HWY_INLINE Mask operator==(Real a, Real b) { return hn::Eq(a.v, b.v); }
};

/// a b + c, rounded once.
HWY_INLINE Real fma(Real a, Real b, Real c) { return hn::MulAdd(a.v, b.v, c.v); }
/// a b - c, rounded once.
HWY_INLINE Real fms(Real a, Real b, Real c) { return hn::MulSub(a.v, b.v, c.v); }
/// c - a b, rounded once.
HWY_INLINE Real fnma(Real a, Real b, Real c) { return hn::NegMulAdd(a.v, b.v, c.v); }
HWY_INLINE Real sqrt(Real a) { return hn::Sqrt(a.v); }
HWY_INLINE Real abs(Real a) { return hn::Abs(a.v); }
HWY_INLINE Real floor(Real a) { return hn::Floor(a.v); }
HWY_INLINE Real copysign(Real a, Real sign) { return hn::CopySign(a.v, sign.v); }
HWY_INLINE Real min(Real a, Real b) { return hn::Min(a.v, b.v); }
HWY_INLINE Real max(Real a, Real b) { return hn::Max(a.v, b.v); }
HWY_INLINE Real exp(Real a) { return hn::Exp(D(), a.v); }
HWY_INLINE Real expm1(Real a) { return hn::Expm1(D(), a.v); }
HWY_INLINE Real log(Real a) { return hn::Log(D(), a.v); }
HWY_INLINE Real log1p(Real a) { return hn::Log1p(D(), a.v); }
HWY_INLINE Real sin(Real a) { return hn::Sin(D(), a.v); }
HWY_INLINE Real cos(Real a) { return hn::Cos(D(), a.v); }
HWY_INLINE Real atan(Real a) { return hn::Atan(D(), a.v); }
HWY_INLINE Mask is_nan(Real a) { return hn::IsNaN(a.v); }
HWY_INLINE Real select(Mask which, Real yes, Real no) { return hn::IfThenElse(which, yes.v, no.v); }
HWY_INLINE Real or_zero(Mask which, Real yes) { return hn::IfThenElseZero(which, yes.v); }

/// 32 bits, or a whole number that is not negative, in each element.
struct Bits {
  hn::Vec<DU> v;

  Bits() = default;
  HWY_INLINE Bits(hn::Vec<DU> elements) : v(elements) {}
  HWY_INLINE Bits(std::uint32_t same) : v(hn::Set(DU(), same)) {}

  friend HWY_INLINE Bits operator+(Bits a, Bits b) { return hn::Add(a.v, b.v); }
  friend HWY_INLINE Bits operator-(Bits a, Bits b) { return hn::Sub(a.v, b.v); }
  friend HWY_INLINE Bits operator*(Bits a, Bits b) { return hn::Mul(a.v, b.v); }
  friend HWY_INLINE Bits operator&(Bits a, Bits b) { return hn::And(a.v, b.v); }
  friend HWY_INLINE Bits operator^(Bits a, Bits b) { return hn::Xor(a.v, b.v); }
};
template <int by>
HWY_INLINE Bits shift_right(Bits a) {
  return hn::ShiftRight<by>(a.v);
}
template <int by>
HWY_INLINE Bits shift_left(Bits a) {
  return hn::ShiftLeft<by>(a.v);
}
HWY_INLINE Bits min(Bits a, Bits b) { return hn::Min(a.v, b.v); }
HWY_INLINE Bits max(Bits a, Bits b) { return hn::Max(a.v, b.v); }
HWY_INLINE Bits select(Mask which, Bits yes, Bits no) {
  return hn::IfThenElse(hn::RebindMask(DU(), which), yes.v, no.v);
}
/// from, from + 1 ...
HWY_INLINE Bits counting(std::size_t from) {
  return hn::Iota(DU(), static_cast<std::uint32_t>(from));
}

/// Whole numbers below 2^31 as numbers, and numbers without their fraction as whole ones.
HWY_INLINE Real to_real(Bits a) { return hn::ConvertTo(D(), hn::BitCast(DI(), a.v)); }
HWY_INLINE Bits to_whole(Real a) { return hn::BitCast(DU(), hn::ConvertTo(DI(), a.v)); }
/// The bits by which a number is represented, and back.
HWY_INLINE Bits as_bits(Real a) { return hn::BitCast(DU(), a.v); }
HWY_INLINE Real as_real(Bits a) { return hn::BitCast(D(), a.v); }

// ---- directions

struct Vector {
  Real x, y, z;

  friend HWY_INLINE Vector operator+(Vector a, Vector b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend HWY_INLINE Vector operator-(Vector a, Vector b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend HWY_INLINE Vector operator-(Vector a) { return {-a.x, -a.y, -a.z}; }
  friend HWY_INLINE Vector operator*(Real s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
};
HWY_INLINE Real dot(Vector a, Vector b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }
HWY_INLINE Vector cross(Vector a, Vector b) {
  return {fms(a.y, b.z, a.z * b.y), fms(a.z, b.x, a.x * b.z), fms(a.x, b.y, a.y * b.x)};
}
HWY_INLINE Vector fma(Real s, Vector a, Vector b) {
  return {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)};
}
HWY_INLINE Vector fnma(Real s, Vector a, Vector b) {
  return {fnma(s, a.x, b.x), fnma(s, a.y, b.y), fnma(s, a.z, b.z)};
}
HWY_INLINE Vector normalize(Vector a) { return (Real(1) / sqrt(dot(a, a))) * a; }
HWY_INLINE Vector select(Mask which, Vector yes, Vector no) {
  return {select(which, yes.x, no.x), select(which, yes.y, no.y), select(which, yes.z, no.z)};
}
/// By the cosine to z and the angle about it.
HWY_INLINE Vector direction(Real cosine, Real phi) {
  const Real sine = sqrt(max(fnma(cosine, cosine, 1), 0));
  return {sine * cos(phi), sine * sin(phi), cosine};
}

/// vec.h's Frame.
struct Basis {
  Vector x, y, z;

  explicit HWY_INLINE Basis(Vector n) : z(n) {
    const Real sign = copysign(1, n.z), a = Real(-1) / (sign + n.z), b = n.x * n.y * a;
    x = {fma(sign * n.x, n.x * a, 1), sign * b, -(sign * n.x)};
    y = {b, fma(n.y * n.y, a, sign), -n.y};
  }
  HWY_INLINE Vector to_local(Vector v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  HWY_INLINE Vector to_world(Vector v) const { return fma(v.x, x, fma(v.y, y, v.z * z)); }
};

// ---- random numbers

/// A stream of random numbers for each element: the count, hashed with the element's key (the
/// mixing of Wellons 2018, "Prospecting for Hash Functions", twice).
struct Random {
  Bits key_low, key_high, drawn;

  HWY_INLINE Bits bits() {
    drawn = drawn + Bits(0x9e3779b9u);
    return mix(mix(drawn + key_low) + key_high);
  }
  /// In [0, 1).
  HWY_INLINE Real uniform() { return scaled(shift_right<8>(bits())); }
  /// In (0, 1].
  HWY_INLINE Real uniform_positive() { return scaled(shift_right<8>(bits()) + Bits(1)); }

 private:
  static HWY_INLINE Bits mix(Bits h) {
    h = (h ^ shift_right<16>(h)) * Bits(0x21f0aaadu);
    h = (h ^ shift_right<15>(h)) * Bits(0xd35a2d97u);
    return h ^ shift_right<15>(h);
  }
  static HWY_INLINE Real scaled(Bits h) { return to_real(h) * Real(0x1p-24f); }
};

// ---- memory: a place is the first of as many neighbours (std::size_t), or one for each element
// (Bits)

HWY_INLINE Real gather(const float* from, Bits index) {
  return hn::GatherIndex(D(), from, hn::BitCast(DI(), index.v));
}
template <std::size_t n>
HWY_INLINE Real load(const std::array<float, n>& from, std::size_t first_at) {
  return hn::LoadU(D(), &from[first_at]);
}
template <std::size_t n>
HWY_INLINE Real load(const std::array<float, n>& from, Bits at) {
  return gather(from.data(), at);
}
template <std::size_t n>
HWY_INLINE Bits load(const std::array<std::uint32_t, n>& from, std::size_t first_at) {
  return hn::LoadU(DU(), &from[first_at]);
}
template <std::size_t n, class Place>
HWY_INLINE Vector load(const VectorArrays<n>& from, Place at) {
  return {load(from.x, at), load(from.y, at), load(from.z, at)};
}
template <std::size_t n>
HWY_INLINE Random load(const RandomStreams<n>& from, std::size_t first_at) {
  return {load(from.key_low, first_at), load(from.key_high, first_at), load(from.drawn, first_at)};
}

template <std::size_t n>
HWY_INLINE void store(Real value, std::array<float, n>& to, std::size_t first_at) {
  hn::StoreU(value.v, D(), &to[first_at]);
}
template <std::size_t n>
HWY_INLINE void store(Real value, std::array<float, n>& to, Bits at) {
  hn::ScatterIndex(value.v, D(), to.data(), hn::BitCast(DI(), at.v));
}
template <std::size_t n>
HWY_INLINE void store(Bits value, std::array<std::uint32_t, n>& to, std::size_t first_at) {
  hn::StoreU(value.v, DU(), &to[first_at]);
}
template <std::size_t n, class Place>
HWY_INLINE void store(Vector value, VectorArrays<n>& to, Place at) {
  store(value.x, to.x, at);
  store(value.y, to.y, at);
  store(value.z, to.z, at);
}

/// The chosen elements side by side; what lies behind them, up to a register's length, is
/// undefined. Not CompressStore: the processors of Zen 4 take ten times as long for it.
template <std::size_t n>
HWY_INLINE void pack(Real value, Mask chosen, std::array<float, n>& to, std::size_t first_at) {
  hn::StoreU(hn::Compress(value.v, chosen), D(), &to[first_at]);
}
template <std::size_t n>
HWY_INLINE void pack(Bits value, Mask chosen, std::array<std::uint32_t, n>& to,
                     std::size_t first_at) {
  hn::StoreU(hn::Compress(value.v, hn::RebindMask(DU(), chosen)), DU(), &to[first_at]);
}
template <std::size_t n>
HWY_INLINE void pack(Vector value, Mask chosen, VectorArrays<n>& to, std::size_t first_at) {
  pack(value.x, chosen, to.x, first_at);
  pack(value.y, chosen, to.y, first_at);
  pack(value.z, chosen, to.z, first_at);
}
template <std::size_t n>
HWY_INLINE void pack(Random value, Mask chosen, RandomStreams<n>& to, std::size_t first_at) {
  pack(value.key_low, chosen, to.key_low, first_at);
  pack(value.key_high, chosen, to.key_high, first_at);
  pack(value.drawn, chosen, to.drawn, first_at);
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
