// Adaptive quadrature in time, between jumps that are looked for first.
//   [Piessens, de Doncker-Kapenga, Ueberhuber, Kahaner 1983] QUADPACK: the rules of 7 and 15 points, and what
//     their difference says of the error.
#include "simulate/step_mean.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace kropla {
namespace {

// The share of the step, 0 ... 1, stands for the time.
constexpr std::size_t most_witnesses = 32;  // places that are looked at beforehand
constexpr std::size_t close_every = 4;      // of them, one is looked at closely
constexpr int close_looks = 2048, looks = 256;
constexpr std::size_t most_jumps = 64;      // of a witness: what jumps more often is left to the pieces
constexpr double outstanding = 4;           // [-] a jump's change, in those beside it
constexpr double steep = 1.0 / 64;          // [-] of the range, between two looks: may be a jump
constexpr double unseen = 1e-12;            // [-] of the range: changes that are rounding
constexpr double same_jump = 1e-9;          // of the step: two witnesses speak of one jump
constexpr double tolerance = 1e-10;         // [-] of the largest value
constexpr double least_piece = 1e-6;        // of the step

constexpr std::array<double, 8> kronrod_place = {
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0.0};
constexpr std::array<double, 8> kronrod_weight = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array<double, 4> gauss_weight = {  // of every second place
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

/// A time at which the quantity jumps: the last before it and the first after it, neighbours to rounding.
struct Jump {
    double before, after;
};

struct Piece {
    double begin, end;
};

class Integrand {
public:
    Integrand(const Quantity& quantity, double t, double dt, const std::string& key)
        : quantity_(quantity), t_(t), dt_(dt), key_(key) {}

    double operator()(const Way& way, double share) {
        const Vec3 place = (1 - share) * way.from + share * way.to;
        const double value = value_at(quantity_, place, t_ + share * dt_, key_);
        largest_ = std::max(largest_, std::abs(value));
        return value;
    }
    /// The largest size of all values so far.
    [[nodiscard]] double largest() const { return largest_; }

private:
    const Quantity& quantity_;
    double t_, dt_;
    const std::string& key_;
    double largest_ = 0;
};

/// Between two times of different values: the jump, if there is one.
std::vector<Jump> find_jump(Integrand& f, const Way& way, Jump between) {
    double low = f(way, between.before), high = f(way, between.after);
    const double change = std::abs(high - low);
    for (;;) {
        const double middle = 0.5 * (between.before + between.after);
        if (middle <= between.before || middle >= between.after) return {between};
        const double value = f(way, middle);
        if (std::abs(value - low) > std::abs(high - value)) between.after = middle, high = value;
        else between.before = middle, low = value;
        if (std::abs(high - low) < change / 2) return {};  // it is spread out: steep, but no jump
    }
}

/// What a witness saw.
struct Testimony {
    bool varies = false;
    std::vector<Jump> jumps;
};

Testimony look(Integrand& f, const Way& way, int times) {
    std::vector<double> value;
    for (int k = 0; k <= times; ++k) value.push_back(f(way, static_cast<double>(k) / times));
    const auto [least, most] = std::ranges::minmax(value);
    const double range = most - least;
    Testimony seen{.varies = range > unseen * std::max(std::abs(least), std::abs(most)), .jumps = {}};
    const auto change = [&](int k) {
        return k < 0 || k >= times ? 0.0 : std::abs(value[std::size_t(k) + 1] - value[std::size_t(k)]);
    };
    for (int k = 0; k < times && seen.varies; ++k) {
        const bool stands_out =
            change(k) > unseen * range && change(k) > outstanding * std::max(change(k - 2), change(k + 2));
        if (!stands_out && !(change(k) > steep * range)) continue;
        const Jump between{static_cast<double>(k) / times, static_cast<double>(k + 1) / times};
        for (const Jump& jump : find_jump(f, way, between)) seen.jumps.push_back(jump);
        if (seen.jumps.size() > most_jumps) return {.varies = true, .jumps = {}};
    }
    return seen;
}

/// What several witnesses say, or the only one.
Testimony hear_witnesses(Integrand& f, std::span<const Way> ways) {
    const std::size_t count = std::min(ways.size(), most_witnesses);
    Testimony all;
    std::vector<Jump> said;
    for (std::size_t k = 0; k < count; ++k) {
        const Way& way = ways[(2 * k + 1) * ways.size() / (2 * count)];
        const Testimony one = look(f, way, k % close_every == 0 ? close_looks : looks);
        all.varies = all.varies || one.varies;
        said.insert(said.end(), one.jumps.begin(), one.jumps.end());
    }
    std::ranges::sort(said, {}, &Jump::before);
    for (std::size_t k = 0; k < said.size();) {
        std::size_t next = k + 1;
        while (next < said.size() && said[next].before - said[k].before < same_jump) ++next;
        if (next - k > 1 || count == 1) all.jumps.push_back({said[k].before, said[next - 1].after});
        k = next;
    }
    return all;
}

std::vector<Piece> pieces_of_step(const Testimony& seen) {
    std::vector<Piece> pieces;
    double begin = 0;
    const auto add = [&](double end) {
        const int parts = seen.varies ? static_cast<int>(std::ceil(2 * (end - begin))) : 1;
        for (int k = 0; k < parts; ++k)
            pieces.push_back({begin + (end - begin) * k / parts, begin + (end - begin) * (k + 1) / parts});
    };
    for (const Jump& jump : seen.jumps) {
        add(jump.before);
        begin = jump.after;
    }
    add(1);
    return pieces;
}

struct Integral {
    double value, error;
};

Integral integrate(Integrand& f, const Way& way, const Piece& piece) {
    const double middle = 0.5 * (piece.begin + piece.end), half = 0.5 * (piece.end - piece.begin);
    std::array<double, 15> value;
    double kronrod = 0, gauss = 0;
    for (std::size_t k = 0; k < kronrod_place.size(); ++k) {
        double& low = value[k];
        double& high = value[14 - k];
        low = f(way, middle - half * kronrod_place[k]);
        high = k == 7 ? low : f(way, middle + half * kronrod_place[k]);
        const double sum = k == 7 ? low : low + high;
        kronrod += kronrod_weight[k] * sum;
        if (k % 2 == 1) gauss += gauss_weight[k / 2] * sum;
    }
    double spread = 0;  // of the values around their mean
    for (std::size_t k = 0; k < value.size(); ++k)
        spread += kronrod_weight[std::min(k, 14 - k)] * std::abs(value[k] - kronrod / 2);
    const double difference = half * std::abs(kronrod - gauss);
    spread *= half;
    const double share = spread > 0 ? 200 * difference / spread : 0;
    return {half * kronrod, spread * std::min(1.0, share * std::sqrt(share))};
}

double integrate_to_tolerance(Integrand& f, const Way& way, const Piece& piece) {
    const Integral whole = integrate(f, way, piece);
    const double length = piece.end - piece.begin;
    if (whole.error <= tolerance * f.largest() * length || length < least_piece) return whole.value;
    const double middle = 0.5 * (piece.begin + piece.end);
    return integrate_to_tolerance(f, way, {piece.begin, middle}) +
           integrate_to_tolerance(f, way, {middle, piece.end});
}

/// The same value at three times, where nobody saw any change: it stays.
bool stays(Integrand& f, const Way& way) {
    const double begin = f(way, 0);
    return f(way, 0.5) == begin && f(way, 1) == begin;
}

}  // namespace

double value_at(const Quantity& quantity, const Vec3& place, double t, const std::string& key) {
    const double value = quantity(place, t);
    if (std::isfinite(value)) return value;
    std::ostringstream message;
    message << key << " is " << value << " at (" << place.x << ", " << place.y << ", " << place.z
            << ") m, t = " << t << " s";
    throw CaseError(message.str());
}

std::vector<double> step_means(const Quantity& quantity, std::span<const Way> ways, double t, double dt,
                               const std::string& key) {
    if (ways.empty()) return {};
    if (quantity.target<Constant>() != nullptr)
        return std::vector<double>(ways.size(), value_at(quantity, ways.front().to, t + dt, key));
    Integrand f(quantity, t, dt, key);
    const Testimony seen = hear_witnesses(f, ways);
    const std::vector<Piece> pieces = pieces_of_step(seen);
    std::vector<double> means;
    means.reserve(ways.size());
    for (const Way& way : ways) {
        if (!seen.varies && stays(f, way)) {
            means.push_back(f(way, 0));
            continue;
        }
        double sum = 0;
        for (const Piece& piece : pieces) sum += integrate_to_tolerance(f, way, piece);
        means.push_back(sum);
    }
    return means;
}

}  // namespace kropla
