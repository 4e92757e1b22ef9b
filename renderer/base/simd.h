// Numbers, masks and directions of as many lanes as a register has, by Highway: included once for
// each instruction set by the files that are compiled for each (foreach_target.h), never elsewhere.
//
// With AVX-512 and AVX2 every operation rounds as IEEE 754 says and fma() fuses, so that a lane's
// result does not depend on how many lanes there are.

#include <hwy/highway.h>
// After highway.h:
#include <hwy/contrib/math/math-inl.h>

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
using Mask = hn::Mask<D>;
using Bits = hn::Vec<DU>;

/// A number in each lane.
struct Real {
  hn::Vec<D> v;

  Real() = default;
  HWY_INLINE Real(hn::Vec<D> lanes) : v(lanes) {}
  HWY_INLINE Real(float same) : v(hn::Set(D(), same)) {}

  friend HWY_INLINE Real operator+(Real a, Real b) { return hn::Add(a.v, b.v); }
  friend HWY_INLINE Real operator-(Real a, Real b) { return hn::Sub(a.v, b.v); }
  friend HWY_INLINE Real operator-(Real a) { return hn::Neg(a.v); }
  friend HWY_INLINE Real operator*(Real a, Real b) { return hn::Mul(a.v, b.v); }
  friend HWY_INLINE Real operator/(Real a, Real b) { return hn::Div(a.v, b.v); }
  friend HWY_INLINE Mask operator<(Real a, Real b) { return hn::Lt(a.v, b.v); }
  friend HWY_INLINE Mask operator>(Real a, Real b) { return hn::Gt(a.v, b.v); }
  friend HWY_INLINE Mask operator>=(Real a, Real b) { return hn::Ge(a.v, b.v); }
};

/// a b + c, rounded once.
HWY_INLINE Real fma(Real a, Real b, Real c) { return hn::MulAdd(a.v, b.v, c.v); }
/// c - a b, rounded once.
HWY_INLINE Real fnma(Real a, Real b, Real c) { return hn::NegMulAdd(a.v, b.v, c.v); }
HWY_INLINE Real sqrt(Real a) { return hn::Sqrt(a.v); }
HWY_INLINE Real abs(Real a) { return hn::Abs(a.v); }
HWY_INLINE Real min(Real a, Real b) { return hn::Min(a.v, b.v); }
HWY_INLINE Real max(Real a, Real b) { return hn::Max(a.v, b.v); }
HWY_INLINE Real exp(Real a) { return hn::Exp(D(), a.v); }
HWY_INLINE Real expm1(Real a) { return hn::Expm1(D(), a.v); }
HWY_INLINE Real log(Real a) { return hn::Log(D(), a.v); }
HWY_INLINE Real log1p(Real a) { return hn::Log1p(D(), a.v); }
HWY_INLINE Real sin(Real a) { return hn::Sin(D(), a.v); }
HWY_INLINE Real cos(Real a) { return hn::Cos(D(), a.v); }
HWY_INLINE Real select(Mask which, Real yes, Real no) { return hn::IfThenElse(which, yes.v, no.v); }
HWY_INLINE Real or_zero(Mask which, Real yes) { return hn::IfThenElseZero(which, yes.v); }
HWY_INLINE Mask both(Mask a, Mask b) { return hn::And(a, b); }

struct Vector {
  Real x, y, z;

  friend HWY_INLINE Vector operator+(Vector a, Vector b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend HWY_INLINE Vector operator-(Vector a) { return {-a.x, -a.y, -a.z}; }
  friend HWY_INLINE Vector operator*(Real s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
};
HWY_INLINE Real dot(Vector a, Vector b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }
HWY_INLINE Vector fma(Real s, Vector a, Vector b) {
  return {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)};
}
HWY_INLINE Vector normalize(Vector a) { return (Real(1) / sqrt(dot(a, a))) * a; }
HWY_INLINE Vector select(Mask which, Vector yes, Vector no) {
  return {select(which, yes.x, no.x), select(which, yes.y, no.y), select(which, yes.z, no.z)};
}

/// vec.h's Frame.
struct Basis {
  Vector x, y, z;

  explicit HWY_INLINE Basis(Vector n) : z(n) {
    const Real sign = hn::CopySign(Real(1).v, n.z.v), a = Real(-1) / (sign + n.z),
               b = n.x * n.y * a;
    x = {fma(sign * n.x, n.x * a, 1), sign * b, -(sign * n.x)};
    y = {b, fma(n.y * n.y, a, sign), -n.y};
  }
  HWY_INLINE Vector to_local(Vector v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  HWY_INLINE Vector to_world(Vector v) const { return fma(v.x, x, fma(v.y, y, v.z * z)); }
};

/// A stream of random numbers for each lane: the count, hashed with the lane's key (the mixing of
/// Wellons 2018, "Prospecting for Hash Functions", twice).
struct Random {
  Bits key_low, key_high, drawn;

  HWY_INLINE Bits bits() {
    drawn = hn::Add(drawn, hn::Set(DU(), 0x9e3779b9u));
    return mix(hn::Add(mix(hn::Add(drawn, key_low)), key_high));
  }
  /// A number in [0, 1).
  HWY_INLINE Real uniform() { return scaled(hn::ShiftRight<8>(bits())); }
  /// A number in (0, 1].
  HWY_INLINE Real uniform_positive() {
    return scaled(hn::Add(hn::ShiftRight<8>(bits()), hn::Set(DU(), 1)));
  }

 private:
  static HWY_INLINE Bits mix(Bits h) {
    h = hn::Mul(hn::Xor(h, hn::ShiftRight<16>(h)), hn::Set(DU(), 0x21f0aaadu));
    h = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(DU(), 0xd35a2d97u));
    return hn::Xor(h, hn::ShiftRight<15>(h));
  }
  static HWY_INLINE Real scaled(Bits h) {
    return Real(hn::ConvertTo(D(), hn::BitCast(DI(), h))) * Real(0x1p-24f);
  }
};

HWY_INLINE Real load(const float* from) { return hn::LoadU(D(), from); }
HWY_INLINE Bits load(const std::uint32_t* from) { return hn::LoadU(DU(), from); }
HWY_INLINE Real gather(const float* from, Bits index) {
  return hn::GatherIndex(D(), from, hn::BitCast(DI(), index));
}
HWY_INLINE void scatter(Real value, float* to, Bits index) {
  hn::ScatterIndex(value.v, D(), to, hn::BitCast(DI(), index));
}
/// The chosen lanes side by side; what lies behind them, up to a register's length, is undefined.
/// Not CompressStore: the processors of Zen 4 take ten times as long for it.
HWY_INLINE void pack(Real value, Mask chosen, float* to) {
  hn::StoreU(hn::Compress(value.v, chosen), D(), to);
}
HWY_INLINE void pack(Bits value, Mask chosen, std::uint32_t* to) {
  hn::StoreU(hn::Compress(value, hn::RebindMask(DU(), chosen)), DU(), to);
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
