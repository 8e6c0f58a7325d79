#pragma once

#include <cmath>

namespace kropla {

/// A point or a vector in space [m, unless said otherwise], of numbers; or several at once, of Fours (four.h).
template <class Number>
struct Vector3 {
    Number x{}, y{}, z{};

    constexpr Number& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr Number operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }

    constexpr Vector3& operator+=(const Vector3& b) { return x += b.x, y += b.y, z += b.z, *this; }
    constexpr Vector3& operator-=(const Vector3& b) { return x -= b.x, y -= b.y, z -= b.z, *this; }
    constexpr Vector3& operator*=(Number s) { return x *= s, y *= s, z *= s, *this; }
    bool operator==(const Vector3&) const = default;

    friend constexpr Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vector3 operator*(Number s, const Vector3& a) { return {s * a.x, s * a.y, s * a.z}; }
    friend constexpr Vector3 operator*(const Vector3& a, Number s) { return s * a; }
    friend constexpr Vector3 operator/(const Vector3& a, Number s) { return {a.x / s, a.y / s, a.z / s}; }
};
using Vec3 = Vector3<double>;

template <class Number>
constexpr Number dot(const Vector3<Number>& a, const Vector3<Number>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
constexpr Vector3<Number> cross(const Vector3<Number>& a, const Vector3<Number>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Number>
constexpr Number squared_norm(const Vector3<Number>& a) {
    return dot(a, a);
}
inline double norm(const Vec3& a) { return std::sqrt(squared_norm(a)); }
inline double distance(const Vec3& a, const Vec3& b) { return norm(a - b); }
inline Vec3 normalised(const Vec3& a) { return a / norm(a); }
/// [rad] 0 to pi.
inline double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }
inline bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// dot(u, cross(v, w)), rounded: six times the signed volume of a tetrahedron with these edges; for its sign see orient3d.
template <class Number>
constexpr Number determinant(const Vector3<Number>& u, const Vector3<Number>& v, const Vector3<Number>& w) {
    return dot(u, cross(v, w));
}

}  // namespace kropla
