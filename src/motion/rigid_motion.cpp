#include "motion/rigid_motion.h"

#include "simulate/elements.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace kropla {
namespace {

using std::numbers::pi;

Vec3 first_half(const SixVector& v) { return {v[0], v[1], v[2]}; }
Vec3 second_half(const SixVector& v) { return {v[3], v[4], v[5]}; }
SixVector both(const Vec3& a, const Vec3& b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }
Vec3 times(const std::array<Vec3, 3>& m, const Vec3& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

}  // namespace

// Gaussian elimination with pivots [Golub, Van Loan 2013, 3.4].
SixVector solved(SixMatrix a, SixVector b) {
    for (std::size_t k = 0; k < 6; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < 6; ++i)
            if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = k + 1; i < 6; ++i) {
            const double share = a[i][k] / a[k][k];
            for (std::size_t j = k; j < 6; ++j) a[i][j] -= share * a[k][j];
            b[i] -= share * b[k];
        }
    }
    for (std::size_t k = 6; k-- > 0;) {
        for (std::size_t j = k + 1; j < 6; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return b;
}

Weighed weighed(const Mesh& mesh, Region body, double density) {
    Weighed found;
    const Cells cells = living_cells(mesh, body);
    const auto for_each_part = [&](const auto& visit) {
        for_each_cell(cells, [&](const auto& cell) {
            const auto x = corners(mesh, cell);
            const auto points = cell_points(x);
            for (std::size_t k = 0; k < points.size(); ++k) visit(points[k].volume, k, x);
        });
    };
    for_each_part([&](double volume, std::size_t k, const auto& x) {
        found.mass += density * volume;
        found.centre += density * volume * mean_value(k, x);
    });
    if (!(found.mass > 0)) return found;
    found.centre = found.centre / found.mass;
    for_each_part([&](double volume, std::size_t k, const auto& x) {
        constexpr std::size_t n = std::tuple_size_v<std::remove_cvref_t<decltype(x)>>;
        auto arm = x;
        for (Vec3& r : arm) r = r - found.centre;
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 paired = density * volume * mean_product(k, i, arm);  // the mean of phi_i r, and r = sum phi_i r_i
            const Vec3& r = arm[i];
            const double square = dot(r, paired);
            for (int row = 0; row < 3; ++row) {
                found.inertia[static_cast<std::size_t>(row)] -= r[row] * paired;
                found.inertia[static_cast<std::size_t>(row)][row] += square;
            }
        }
    });
    return found;
}

RigidStep::RigidStep(const FreeMotion& motion, const FreeState& state, const Weighed& body, const Vec3& shape_centre,
                     const Vec3& gravity, double t, double dt)
    : motion_(motion), state_(state), body_(body), shape_centre_(shape_centre), gravity_(gravity), t_(t), dt_(dt),
      rate_(state.rate) {
    for (std::size_t i = 0; i < 6; ++i) rate_[i] *= motion.free[i];
}

// A sphere of the body's volume: half the fluid's mass in its place, and the drag of a slow flow that grows with the
// velocity, with what the boundary layer of a step adds to it [Landau, Lifshitz, Fluid mechanics, 24].
void RigidStep::guess_response(double fluid_density, double fluid_viscosity) {
    if (std::exchange(state_.knows_response, true)) return;
    const double volume = body_.mass / motion_.density, radius = std::cbrt(0.75 * volume / pi);
    const double layer = std::sqrt(fluid_viscosity * dt_ / fluid_density);
    const double drag = 6 * pi * fluid_viscosity * radius * (1 + radius / layer) * dt_ / 2;
    const double turning = 8 * pi * fluid_viscosity * radius * radius * radius * (1 + radius / (3 * layer)) * dt_ / 2;
    for (std::size_t i = 0; i < 6; ++i)
        state_.response[i][i] = i < 3 ? 0.5 * fluid_density * volume + drag : turning;
}

RigidVelocity RigidStep::velocity(double t) const {
    const double s = t - t_;
    const Vec3 a = first_half(rate_);
    RigidVelocity now = {body_.centre + s * state_.velocity + 0.5 * s * s * a, state_.velocity + s * a,
                         state_.spin + s * second_half(rate_)};
    if (leaps_) {
        const double left = 1 - s / dt_;
        now.centre += s * (1 + left) / 2 * first_half(leap_);
        now.velocity += left * first_half(leap_);
        now.spin += left * second_half(leap_);
    }
    return now;
}

Pose RigidStep::pose() const {
    Vec3 turn = dt_ * (state_.spin + 0.5 * dt_ * second_half(rate_));
    if (leaps_) turn += 0.5 * dt_ * second_half(leap_);
    const double angle = norm(turn);
    const Rotation turned = angle > 0 ? rotation_about(turn, angle) : Rotation{};
    const Vec3 arm = shape_centre_ - body_.centre;
    const Vec3 centre = velocity(t_ + dt_).centre + rotated(turned, arm);
    return {state_.pose.displacement + (centre - shape_centre_), turned * state_.pose.rotation};
}

FreeState RigidStep::end() const {
    const RigidVelocity last = velocity(t_ + dt_);
    FreeState state = state_;
    state.pose = pose();
    state.velocity = last.velocity;
    state.spin = last.spin;
    state.rate = leaps_ ? SixVector{} : rate_;  // what a touch did to it does not go on
    return state;
}

/// What acts, less what the rate takes.
SixVector RigidStep::missing(const Vec3& force, const Vec3& torque) const {
    const Vec3 spin = state_.spin + 0.5 * dt_ * second_half(rate_);
    const Vec3 rest = force + body_.mass * (gravity_ - first_half(rate_));
    const Vec3 turning = torque - cross(spin, times(body_.inertia, spin)) - times(body_.inertia, second_half(rate_));
    SixVector all = both(rest, turning);
    for (std::size_t i = 0; i < 6; ++i) all[i] *= motion_.free[i];
    return all;
}

double RigidStep::take(const Vec3& force, const Vec3& torque) {
    missing_ = missing(force, torque);
    if (last_rate_) {  // Broyden's update: what was missing changed by the response and the inertia, times the change
        SixVector step, seen;
        double square = 0;
        const double length = std::cbrt(body_.mass / motion_.density);  // so that both halves weigh alike
        for (std::size_t i = 0; i < 6; ++i) {
            step[i] = (rate_[i] - (*last_rate_)[i]) * (i < 3 ? 1 : length);
            square += step[i] * step[i];
        }
        for (std::size_t i = 0; i < 6; ++i) {
            seen[i] = last_missing_[i] - missing_[i];
            for (std::size_t j = 0; j < 6; ++j) {
                const double change = rate_[j] - (*last_rate_)[j];
                double inertia = i == j && i < 3 ? body_.mass : 0;
                if (i >= 3 && j >= 3) inertia = body_.inertia[i - 3][static_cast<int>(j - 3)];
                seen[i] -= (inertia * motion_.free[i] + state_.response[i][j]) * change;
            }
        }
        if (square > 0)
            for (std::size_t i = 0; i < 6; ++i)
                for (std::size_t j = 0; j < 6; ++j)
                    state_.response[i][j] += seen[i] * step[j] * (j < 3 ? 1 : length) / square;
    }
    const double radius = std::cbrt(0.75 * body_.mass / (motion_.density * pi));
    acting_ = std::max({norm(force), body_.mass * norm(gravity_), norm(torque) / radius});
    return scaled(missing_, acting_);
}

double RigidStep::scaled(const SixVector& wrench, double acting) const {
    const double radius = std::cbrt(0.75 * body_.mass / (motion_.density * pi));
    const double left = std::max(norm(first_half(wrench)), norm(second_half(wrench)) / radius);
    return acting > 0 ? left / acting : 0;
}

double RigidStep::share(const SixVector& wrench, double contact) const {
    return scaled(wrench, std::max(acting_, contact));
}

SixMatrix RigidStep::resistance(bool of_flow) const {
    SixMatrix matrix = of_flow ? state_.response : SixMatrix{};
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 6; ++j) {
            if (i == j && i < 3) matrix[i][j] += body_.mass;
            if (i >= 3 && j >= 3) matrix[i][j] += body_.inertia[i - 3][static_cast<int>(j - 3)];
            if (motion_.free[i] == 0 || motion_.free[j] == 0) matrix[i][j] = i == j ? 1 : 0;
        }
    }
    return matrix;
}

void RigidStep::improve() {
    const SixVector change = solved(resistance(), missing_);
    last_rate_ = rate_;
    last_missing_ = missing_;
    for (std::size_t i = 0; i < 6; ++i) rate_[i] += change[i];
}

void RigidStep::go(const SixVector& rate, const SixVector& leap) {
    rate_ = rate;
    leap_ = leap;
    leaps_ = leap_ != SixVector{};
}

double RigidStep::length() const { return std::cbrt(body_.mass / motion_.density); }

// The derivative of the motion by differences over a small part of the step; of the rotation, R' R^T is the spin's cross.
RigidVelocity velocity_of(const Body& body, double t, double dt) {
    constexpr double part = 1e-3;  // [-] of the step: the cube of it is lost, as is rounding over it
    const double h = part * dt;
    const Pose before = body.motion(t - h), after = body.motion(t + h), now = body.motion(t);
    RigidVelocity velocity{body.shape.centre + now.displacement, (after.displacement - before.displacement) / (2 * h), {}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit;
        unit[axis] = 1;
        const Vec3 e = rotated(now.rotation, unit);
        const Vec3 rate = (rotated(after.rotation, unit) - rotated(before.rotation, unit)) / (2 * h);
        velocity.spin += 0.5 * cross(e, rate);
    }
    return velocity;
}

}  // namespace kropla
