// Adaptive quadrature in time, between jumps that are looked for first.
//   [Gander, Gautschi 2000] Adaptive quadrature - revisited. BIT 40: Lobatto's rules, as what jumps near an end is
//     seen by the end; here of seven points, and a piece against its halves.
#include "simulate/step_mean.h"

#include <kropla/base/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
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

// Lobatto's rule of seven points on -1 ... 1, exact to degree 11: the right half.
constexpr std::array<double, 4> lobatto_place = {0.0, 0.468848793470714213803771881908766,
                                                 0.830223896278566929872032213967465, 1.0};
constexpr std::array<double, 4> lobatto_weight = {
    0.487619047619047619047619047619048, 0.431745381209862623417871022281362,
    0.276826047361565948010700406290066, 0.047619047619047619047619047619048};

/// A time at which the quantity jumps: the last before it and the first after it, neighbours to rounding.
struct Jump {
    double before, after;
};

struct Piece {
    double begin, end;
};

class Integrand {
public:
    Integrand(const Quantity& quantity, double t, double dt, const std::string& key, const Watch* watch)
        : quantity_(quantity), t_(t), dt_(dt), key_(key), watch_(watch) {}

    double operator()(const Way& way, double share) {
        const Vec3 place = (1 - share) * way.from + share * way.to;
        const double value = value_at(quantity_, place, t_ + share * dt_, key_);
        largest_ = std::max(largest_, std::abs(value));
        return value;
    }
    /// The largest size of all values so far.
    [[nodiscard]] double largest() const { return largest_; }
    /// The watch of the integration.
    [[nodiscard]] const Watch* watch() const { return watch_; }

private:
    const Quantity& quantity_;
    double t_, dt_;
    const std::string& key_;
    const Watch* watch_;
    double largest_ = 0;
};

/// Between two times of different values: the jump, if there is one.
std::vector<Jump> find_jump(Integrand& f, const Way& way, Jump between) {
    heed(f.watch());
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
    heed(f.watch());
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

double integrate(Integrand& f, const Way& way, const Piece& piece) {
    const double middle = 0.5 * (piece.begin + piece.end), half = 0.5 * (piece.end - piece.begin);
    double sum = lobatto_weight[0] * f(way, middle);
    for (std::size_t k = 1; k < lobatto_place.size(); ++k) {
        const double low = k == 3 ? piece.begin : middle - half * lobatto_place[k];
        const double high = k == 3 ? piece.end : middle + half * lobatto_place[k];
        sum += lobatto_weight[k] * (f(way, low) + f(way, high));
    }
    return half * sum;
}

/// `whole` is the rule's value for the piece.
double refine(Integrand& f, const Way& way, const Piece& piece, double whole) {
    heed(f.watch());  // of one place there may be a million pieces
    const double length = piece.end - piece.begin, middle = 0.5 * (piece.begin + piece.end);
    const Piece low{piece.begin, middle}, high{middle, piece.end};
    const double of_low = integrate(f, way, low), of_high = integrate(f, way, high);
    if (std::abs(of_low + of_high - whole) <= tolerance * f.largest() * length || length < least_piece)
        return of_low + of_high;
    return refine(f, way, low, of_low) + refine(f, way, high, of_high);
}

/// The value, if it is the same at three times and no witness saw any change.
std::optional<double> lasting_value(Integrand& f, const Way& way, const Testimony& seen) {
    if (seen.varies) return std::nullopt;
    const double begin = f(way, 0);
    if (f(way, 0.5) != begin || f(way, 1) != begin) return std::nullopt;
    return begin;
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
                               const std::string& key, const Watch* watch) {
    if (ways.empty()) return {};
    if (quantity.target<Constant>() != nullptr)
        return std::vector<double>(ways.size(), value_at(quantity, ways.front().to, t + dt, key));
    Integrand f(quantity, t, dt, key, watch);
    const Testimony seen = hear_witnesses(f, ways);
    const std::vector<Piece> pieces = pieces_of_step(seen);
    std::vector<double> means;
    means.reserve(ways.size());
    for (const Way& way : ways) {
        heed(watch);
        if (const auto value = lasting_value(f, way, seen)) {
            means.push_back(*value);
            continue;
        }
        double sum = 0;
        for (const Piece& piece : pieces) sum += refine(f, way, piece, integrate(f, way, piece));
        means.push_back(sum);
    }
    return means;
}

}  // namespace kropla
