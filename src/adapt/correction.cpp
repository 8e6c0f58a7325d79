#include "adapt/correction.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace kropla {
namespace {

Rotation inverse(const Rotation& r) {
    Rotation back;
    for (int i = 0; i < 3; ++i) {
        Vec3 unit;
        unit[i] = 1;
        back.axes[as_size(i)] = rotated_back(r, unit);
    }
    return back;
}

/// The share of a rotation, about its own axis.
Rotation share_of(const Rotation& r, double share) {
    const auto& [x, y, z] = r.axes;
    const Vec3 twice_sine{y.z - z.y, z.x - x.z, x.y - y.x};  // times the axis
    const double sine = norm(twice_sine) / 2, cosine = (x.x + y.y + z.z - 1) / 2;
    if (sine == 0) return share < 1 ? Rotation{} : r;  // none; a half turn, which no step makes, stands at its end
    return rotation_about(twice_sine, share * std::atan2(sine, cosine));
}

Rotation between(const Rotation& from, const Rotation& to, double share) {
    if (share == 0) return from;
    if (share == 1) return to;
    return share_of(to * inverse(from), share) * from;
}

}  // namespace

Correction correction(const Pose& planned, const Pose& real) {
    return {real.displacement - planned.displacement, real.rotation * inverse(planned.rotation)};
}

PlannedMotions::PlannedMotions(const Domain& domain, double t) {
    for (const Body& body : domain.bodies) motion.push_back(body.motion);
    corrected.assign(motion.size(), {{}, {}, t, t + 1});
}

void PlannedMotions::correct(Domain& domain, const BodyPlace& place, double t) {
    if (place.body >= motion.size()) throw std::logic_error("a body is told its place that the domain has not");
    const Correction there = correction(motion[place.body](t), place.pose);
    corrected[place.body] = {there, there, t, t + 1};
    domain.bodies[place.body].motion = kropla::corrected(motion[place.body], corrected[place.body]);
}

Motion corrected(Motion planned, const CorrectedStep& step) {
    return [planned = std::move(planned), step](double t) {
        const double share = std::clamp((t - step.t0) / (step.t1 - step.t0), 0.0, 1.0);
        const Pose plan = planned(t);
        const Vec3 aside = step.from.displacement + share * (step.to.displacement - step.from.displacement);
        return Pose{plan.displacement + aside, between(step.from.rotation, step.to.rotation, share) * plan.rotation};
    };
}

}  // namespace kropla
