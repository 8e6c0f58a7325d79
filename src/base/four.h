#pragma once

#include <kropla/base/vec3.h>

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>

/// Before a function: it is compiled for processors of several generations, and at run time the one is taken
/// that suits. None of them fuses or reorders arithmetic, so that the bits are the same.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define KROPLA_FOR_EACH_PROCESSOR [[gnu::target_clones("avx2", "default")]]
#else
#define KROPLA_FOR_EACH_PROCESSOR
#endif

/// Besides: so is all that it calls. Clang has not both.
#if defined(__clang__)
#define KROPLA_WITH_ITS_CALLS
#else
#define KROPLA_WITH_ITS_CALLS [[gnu::flatten]]
#endif

namespace kropla {

/// Four numbers, on which arithmetic works at once; each with the bits that it would have by itself.
struct alignas(32) Four {
    using Register [[gnu::vector_size(32)]] = double;
    Register all{};

    Four() = default;
    Four(double a) : all{a, a, a, a} {}
    explicit Four(const Register& a) : all(a) {}

    double operator[](std::size_t which) const { return all[which]; }
    void set(std::size_t which, double a) { all[which] = a; }

    friend Four operator+(const Four& a, const Four& b) { return Four(a.all + b.all); }
    friend Four operator-(const Four& a, const Four& b) { return Four(a.all - b.all); }
    friend Four operator*(const Four& a, const Four& b) { return Four(a.all * b.all); }
    friend Four operator/(const Four& a, const Four& b) { return Four(a.all / b.all); }
    friend Four operator-(const Four& a) { return Four(-a.all); }
    Four& operator+=(const Four& b) { return all += b.all, *this; }
    Four& operator-=(const Four& b) { return all -= b.all, *this; }
    Four& operator*=(const Four& b) { return all *= b.all, *this; }
};

inline Four greater(const Four& a, const Four& b) { return Four(a.all > b.all ? a.all : b.all); }

inline Four square_root(const Four& a) {
    Four root;
    for (std::size_t i = 0; i < 4; ++i) root.all[i] = std::sqrt(a.all[i]);
    return root;
}

inline Four size(const Four& a) { return greater(a, -a); }

/// `then` where a > 0, elsewhere zero.
inline Four where_positive(const Four& a, const Four& then) {
    const Four zero;
    return Four(a.all > zero.all ? then.all : zero.all);
}

/// The same of one number, to the same bits.
inline double square_root(double a) { return std::sqrt(a); }
inline double size(double a) { return std::abs(a); }
inline double where_positive(double a, double then) { return a > 0 ? then : 0; }

/// Is a > b in all four?
inline bool all_greater(const Four& a, const Four& b) {
    const auto is = a.all > b.all;
    return (is[0] & is[1] & is[2] & is[3]) != 0;
}

/// Four points or vectors at once.
using FourVec3 = Vector3<Four>;

inline FourVec3 four_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return {Four(Four::Register{a.x, b.x, c.x, d.x}), Four(Four::Register{a.y, b.y, c.y, d.y}),
            Four(Four::Register{a.z, b.z, c.z, d.z})};
}

inline FourVec3 four_times(const Vec3& a) { return {a.x, a.y, a.z}; }

inline void set(FourVec3& fours, std::size_t which, const Vec3& a) {
    fours.x.set(which, a.x);
    fours.y.set(which, a.y);
    fours.z.set(which, a.z);
}
inline Vec3 one_of(const FourVec3& fours, std::size_t which) { return {fours.x[which], fours.y[which], fours.z[which]}; }

/// What `of` says of each of four things, as many numbers or places.
template <class Thing, class Of>
auto together(const std::array<Thing, 4>& things, const Of& of) {
    const auto &a = of(things[0]), &b = of(things[1]), &c = of(things[2]), &d = of(things[3]);
    std::array<Four, std::tuple_size_v<std::remove_cvref_t<decltype(a)>>> fours;
    for (std::size_t i = 0; i < fours.size(); ++i) fours[i] = Four(Four::Register{a[i], b[i], c[i], d[i]});
    return fours;
}
template <class Thing, class Of>
auto places_together(const std::array<Thing, 4>& things, const Of& of) {
    const auto &a = of(things[0]), &b = of(things[1]), &c = of(things[2]), &d = of(things[3]);
    std::array<FourVec3, std::tuple_size_v<std::remove_cvref_t<decltype(a)>>> fours;
    for (std::size_t i = 0; i < fours.size(); ++i) fours[i] = four_of(a[i], b[i], c[i], d[i]);
    return fours;
}

}  // namespace kropla
