#include "case/deformation.h"

#include <kropla/base/error.h>
#include <kropla/domain/words.h>

#include <fmt/format.h>
#include <oneapi/tbb/enumerable_thread_specific.h>

#include <memory>

namespace kropla {
namespace {

/// A velocity that many threads may ask for at once.
class VelocityField {
public:
    VelocityField(const std::array<Expression, 3>& velocity, std::string what)
        : components_([velocity] { return velocity; }), what_(std::move(what)) {}

    [[nodiscard]] Vec3 operator()(const Vec3& x, double t) {
        const auto& [u, v, w] = components_.local();
        const Vec3 velocity{u(t, x), v(t, x), w(t, x)};
        if (is_finite(velocity)) return velocity;
        throw CaseError(fmt::format("{}: is not a number at {}, t = {}", what_, place_words(x), time_words(t)));
    }

private:
    tbb::enumerable_thread_specific<std::array<Expression, 3>> components_;
    std::string what_;
};

/// A step of the classical method of Runge and Kutta.
Vec3 gone(VelocityField& velocity, const Vec3& x, double t, double dt) {
    const Vec3 a = velocity(x, t), b = velocity(x + dt / 2 * a, t + dt / 2);
    const Vec3 c = velocity(x + dt / 2 * b, t + dt / 2), d = velocity(x + dt * c, t + dt);
    return x + dt / 6 * (a + 2 * b + 2 * c + d);
}

}  // namespace

Deformation deformation_by(const std::array<Expression, 3>& velocity, const std::string& what) {
    constexpr int parts = 2;  // of a step, which takes a surface on by a size or so: the fourth power of that is lost
    return [field = std::make_shared<VelocityField>(velocity, what)](Vec3 x, double t0, double t1) {
        for (int i = 0; i < parts; ++i) x = gone(*field, x, t0 + (t1 - t0) * i / parts, (t1 - t0) / parts);
        return x;
    };
}

}  // namespace kropla
