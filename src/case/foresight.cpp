// What can be known of a run before it starts.
#include "case/foresight.h"

#include <kropla/base/error.h>
#include "domain/approach.h"
#include "domain/layer_room.h"
#include "domain/paths.h"
#include <kropla/domain/solids.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

/// Of `doubtful_gap`: by measurement, bodies that passed or landed at half of it did not arrive, at three
/// quarters they did.
constexpr double hopeless_share = 0.5;
constexpr double units_differ = 300;  // times: near 1000, if one is some times larger than the other anyway

double largest_extent(const Box& box) {
    const Vec3 span = box.max - box.min;
    return std::max({span.x, span.y, span.z});
}

/// How short edges may become in the gap [m]: where a body has a layer they stay as they are, and so they are at the start.
double finest(const Domain& domain, const Approach& gap) {
    const bool layered = domain.bodies[gap.body].layer || (gap.wall < 0 && domain.bodies[gap.other].layer);
    return layered || gap.time == 0 ? domain.size.surface : least_size(domain.size);
}

/// The surface sizes that one gap has room for if that many are to fit.
SizeLimit limit_of(const Domain& domain, const Approach& gap, double in_sizes) {
    return {size_for_gap(domain, gap, in_sizes),
            fmt::format("at t = {} {}, too close", time_words(gap.time), in_words(domain, gap))};
}

/// The size field made coarser by and by: first all of it, up to `most_surface`; then far; then steeper.
class Coarser {
public:
    Coarser(const Domain& domain, double most_surface) : domain_(domain), most_surface_(most_surface) {}

    /// `stage` from 0, as it is, to 3.
    [[nodiscard]] Domain at(double stage) const {
        Domain coarser = domain_;
        SizeField& size = coarser.size;
        const double span = largest_extent(domain_.box);
        const double all = std::max(1.0, std::min(most_surface_, span) / size.surface);
        const double factor = std::pow(all, std::clamp(stage, 0.0, 1.0));
        size.surface =
            std::min(two_digits(factor * size.surface), rounded_down(std::min(most_surface_, span)));
        const double wider = std::max(1.0, span / (factor * size.far));
        const double widened = factor * std::pow(wider, std::clamp(stage - 1, 0.0, 1.0));
        size.far = std::max(size.surface, two_digits(widened * size.far));
        if (size.growth < steepest_growth && stage > 2)
            size.growth = two_digits(size.growth + (stage - 2) * (steepest_growth - size.growth));
        return coarser;
    }

    /// The first of these with a count of tets that a machine holds; nothing if none has.
    [[nodiscard]] std::optional<SizeField> affordable() const {
        double too_fine = 0, will_do = 3;
        if (estimate_tets(at(will_do)) > most_tets) return std::nullopt;
        for (int halving = 0; halving < 24; ++halving) {
            const double middle = (too_fine + will_do) / 2;
            (estimate_tets(at(middle)) <= most_tets ? will_do : too_fine) = middle;
        }
        return at(will_do).size;
    }

private:
    static double two_digits(double x) { return std::stod(fmt::format("{:.1e}", x)); }
    const Domain& domain_;
    double most_surface_;  // [m]
};

std::string in_words(const SizeField& size, double growth_before) {
    const std::string growth = size.growth != growth_before ? fmt::format(", growth = {}", size.growth) : "";
    return fmt::format("surface = {}{} and far = {} would do", size.surface, growth, size.far);
}

std::string too_many(double tets) {
    return fmt::format("asks for about {:.1e} tets, more than {:.0e}", tets, most_tets);
}

/// The least gap that the layers of what comes near each other need [m]; 0 without layers outside.
const LayerOptions* neediest_layer(const Domain& domain, const Approach& gap) {
    const LayerOptions* neediest = nullptr;
    const auto ask = [&](std::size_t body) {
        const auto& layer = domain.bodies[body].layer;
        if (!layer || !has_outside(*layer)) return;
        if (neediest == nullptr || least_gap(*layer) > least_gap(*neediest)) neediest = &*layer;
    };
    ask(gap.body);
    if (gap.wall < 0) ask(gap.other);
    return neediest;
}

void check_layer_gap(const Domain& domain, const Approach& gap) {
    const LayerOptions* layer = neediest_layer(domain, gap);
    if (layer == nullptr || gap.gap >= least_gap(*layer)) return;
    throw DomainError(fmt::format("at t = {} {}, less than layer.min_gap = {:.3g} m{}", time_words(gap.time), in_words(domain, gap),
                                  least_gap(*layer),
                                  gap.gap > 0 ? fmt::format("; at most {:.2g} m would do", rounded_down(gap.gap)) : ""));
}

/// The farthest gap that is of interest [m].
double interest(const Case& given) {
    double near = doubtful_gap(given.quality.max_aspect_ratio) * given.domain.size.surface / (1 - share_of_gap);
    for (const Body& body : given.domain.bodies)
        if (body.layer && has_outside(*body.layer)) near = std::max(near, least_gap(*body.layer));
    double out = 0;  // most that two polyhedra stand out, together
    for (std::size_t body = 0; body < given.domain.bodies.size(); ++body)
        out = std::max(out, 2 * stand_out(given.domain, {.body = body, .wall = 0}));
    return near + out;
}

/// The times in the run of which the motions' formulas speak, also by a parameter.
std::vector<double> times_in_formulas(const Case& given) {
    std::vector<double> times;
    const auto add = [&](const std::string& formula) {
        for (double number : numbers_in(formula))
            if (number > 0 && number < given.time.end) times.push_back(number);
    };
    for (const WrittenBody& body : given.written_bodies) {
        for (const std::string& part : body.motion) add(part);
        add(body.angle);
        add(body.axis);
    }
    for (const Parameter& parameter : given.parameters)
        if (parameter.value > 0 && parameter.value < given.time.end) times.push_back(parameter.value);
    return times;
}

PathLook look(const Case& given, const Watch* watch) {
    constexpr double shortest = 1e-3;  // of the step wanted: a step is not cut below
    return look_at_paths(given.domain, {.start = 0,
                                     .end = given.time.end,
                                     .steps = given.time.steps,
                                     .near = interest(given),
                                     .shortest = shortest * given.time.end / given.time.steps,
                                     .also_at = times_in_formulas(given),
                                     .watch = watch});
}

/// What the gaps on the way, and the bodies at the start, allow; and all gaps that are of interest. Looks no
/// wider than the size of the case makes it.
struct Allowed {
    SizeLimit limit;
    PathLook seen;
};
Allowed look_at_all(const Case& given, const Watch* watch) {
    const double sure = doubtful_gap(given.quality.max_aspect_ratio), least = hopeless_share * sure;
    const SizeLimit none{std::numeric_limits<double>::infinity(), {}};  // what is meshed already fits at the start
    Allowed all{given.mesh ? none : surface_limit(given.domain, 0, least_gap_in_sizes), look(given, watch)};
    for (const Approach& gap : all.seen.closest) {
        if (size_for_gap(given.domain, gap, least) >= finest(given.domain, gap)) continue;
        const SizeLimit on_way = limit_of(given.domain, gap, sure);  // what is advised shall really do
        if (on_way.most < all.limit.most) all.limit = on_way;
    }
    return all;
}

/// A size that asks for few enough tets and keeps to all limits, if there is one; what limits it is in
/// `limit`.
std::optional<SizeField> affordable(Case given, SizeLimit& limit, const Watch* watch) {
    constexpr int rounds =
        4;  // a coarser size has more gaps that are narrow for it, which are looked at anew
    const Domain wanted = given.domain;
    for (int round = 0; round < rounds; ++round) {
        const std::optional<SizeField> size = Coarser(wanted, limit.most).affordable();
        if (!size) return std::nullopt;
        given.domain.size = *size;
        const SizeLimit found = look_at_all(given, watch).limit;
        if (found.most >= size->surface) return size;
        limit = found;
    }
    return std::nullopt;
}

/// The layer that makes the triangles under it smallest against what is asked for, if much smaller; empty if none does.
std::string thin_layer(const Domain& domain) {
    const Snapshot at = snapshot(domain, 0);
    std::string thinnest;
    double least = 0.1;
    for (std::size_t body = 0; body < domain.bodies.size(); ++body) {
        const double size = surface_size(at, body), ratio = size / asked_size(domain, body);
        if (!domain.bodies[body].layer || !(ratio < least)) continue;
        least = ratio;
        thinnest = fmt::format(": the layer of {} ends in such thin prisms that triangles there are at most {} large; a larger "
                               "first_height would do", named(domain.bodies[body]), metres(size));
    }
    return thinnest;
}

/// Throws if the sizes do not fit what limits them, or ask for too many tets. What is advised satisfies both.
void check_sizes(const Case& given, SizeLimit limit, const Watch* watch) {
    const SizeField& asked = given.domain.size;
    const bool is_fine = asked.surface <= limit.most;
    Case fitting = given;
    if (!is_fine) fitting.domain.size.surface = rounded_down(limit.most);
    const double tets = given.mesh ? count_tets(*given.mesh->mesh) : estimate_tets(fitting.domain);
    if (tets <= most_tets) {
        if (is_fine) return;
        throw DomainError(too_coarse(limit, asked.surface) + unit_hint(given.domain));
    }
    SizeLimit binding = limit;
    const std::optional<SizeField> size = affordable(fitting, binding, watch);
    std::string text =
        is_fine ? "size " + too_many(tets) : too_coarse(limit, asked.surface) + ", which " + too_many(tets);
    if (size) text += "; " + in_words(*size, asked.growth);
    else if (const std::string layer = thin_layer(fitting.domain); !layer.empty()) text += layer;
    else if (std::isfinite(binding.most))
        text += fmt::format(": no one size does, as {} for more than {}", binding.why, metres(binding.most));
    throw DomainError(text + unit_hint(given.domain));
}

/// Where the box is so thin that cells are much smaller than asked for.
std::string thin_box(const Domain& domain) {
    const double size = largest_size(domain.box, domain.size);
    if (size >= domain.size.far / 2) return "";
    return fmt::format(
        "the box is so thin that cells are at most {} large, not size.far = {}: about {:.1e} tets",
        metres(size), metres(domain.size.far), estimate_tets(domain));
}

std::string doubt(const Case& given, const Approach& gap, double in_sizes) {
    const double size = given.domain.size.surface;
    return fmt::format(
        "at t = {} {}, {:.2g} of size.surface = {}: the mesh may not get there; at most {} surely does",
        time_words(gap.time), in_words(given.domain, gap), gap.gap / size, metres(size),
        metres(rounded_down(size_for_gap(given.domain, gap, in_sizes))));
}

/// What becomes of a cut body at a time that its mesh cannot follow; empty if nothing. A slab or a cylinder goes on behind the
/// faces that it reaches through, so it does not leave them.
std::string gone_wrong(const Case& given, std::size_t body, const StandsInBox& start, double t) {
    const std::string& shape = given.written_bodies[body].shape;
    const StandsInBox stands = stands_in_box(given.domain.bodies[body], t);
    if (!stands.at_all) return "nothing of its surface is left in the box";
    for (int face = 0; face < box_faces; ++face) {
        if (reaches(stands.faces, face) && !reaches(start.faces | start.beyond, face))
            return fmt::format("it comes to {}, which it does not reach through at the start", wall_name(face));
        if (!reaches(stands.faces, face) && reaches(start.faces, face) && shape != "slab" && shape != "cylinder")
            return fmt::format("it leaves {}, which it reaches through at the start", wall_name(face));
    }
    return "";
}

/// Throws if a cut body comes to other faces of the box than those it reaches through, or leaves them, or the box; looked at
/// at a hundred times.
void check_faces_reached(const Case& given, std::size_t body, const Watch* watch) {
    constexpr int looks = 100, halvings = 12;
    const StandsInBox start = stands_in_box(given.domain.bodies[body], 0);
    for (int look = 1; look <= looks; ++look) {
        heed(watch);
        double right = given.time.end * (look - 1) / looks, wrong = given.time.end * look / looks;
        std::string what = gone_wrong(given, body, start, wrong);
        if (what.empty()) continue;
        for (int halving = 0; halving < halvings; ++halving) {
            const double middle = (right + wrong) / 2;
            const std::string then = gone_wrong(given, body, start, middle);
            (then.empty() ? right : wrong) = middle;
            if (!then.empty()) what = then;
        }
        throw DomainError(fmt::format("{}: at t = {} {}; its motion is to end before", named(given.domain.bodies[body]),
                                      time_words(wrong), what));
    }
}

/// Throws if a rigid body would come through a face of the box as another section than the one that is cut there.
void check_cut_bodies(const Case& given, const Watch* watch) {
    for (std::size_t body = 0; body < given.domain.bodies.size(); ++body) {
        const Body& of = given.domain.bodies[body];
        if (!of.shape.cut || !given.written_bodies[body].velocity.empty()) continue;
        for (int step = 1; step <= given.time.steps; ++step) {
            heed(watch);
            check_upright(of, given.time.end * step / given.time.steps);
        }
        check_faces_reached(given, body, watch);
    }
}

/// Throws if a free body begins nearer to something than it may come.
void check_start(const Case& given) {
    if (!given.contact) return;
    FreeSteps bodies;
    for (std::size_t body = 0; body < given.free.size(); ++body)
        if (given.free[body]) bodies.emplace_back(body, RigidStep(*given.free[body], {}, {}, {}, {}, 0, 0));
    Contacts at_start(given.domain, *given.contact, 0, bodies, 0, 0);
    const std::vector<double> gaps = at_start.report().gaps;
    for (const auto& [body, step] : bodies)
        if (gaps[body] < given.contact->gap)
            throw DomainError(fmt::format("{} begins {} from what is nearest to it, less than contact.gap = {}",
                                          named(given.domain.bodies[body]), metres(gaps[body]), metres(given.contact->gap)));
}

}  // namespace

std::vector<double> numbers_in(std::string_view formula) {
    std::vector<double> numbers;
    const char *at = formula.data(), *end = at + formula.size();
    bool in_word = false;  // a digit in a name is no number
    while (at != end) {
        const auto c = static_cast<unsigned char>(*at);
        double number = 0;
        const auto [stop, error] = std::from_chars(at, end, number);
        if (!in_word && (std::isdigit(c) || c == '.') && error == std::errc()) {
            numbers.push_back(number);
            at = stop;
            continue;
        }
        in_word = std::isalnum(c) || c == '_';
        ++at;
    }
    return numbers;
}

std::string unit_hint(const Domain& domain) {
    const double span = largest_extent(domain.box);
    const auto asked = [](const std::string& what, double ratio) {
        return fmt::format(" ({}, about {:.0f} times: is one of them in millimetres?)", what, ratio);
    };
    for (const Body& body : domain.bodies) {
        const Vec3& axes = body.shape.semi_axes;
        const double size = 2 * std::max({axes.x, axes.y, axes.z});
        if (span >= units_differ * size)
            return asked("the box is far larger than " + named(body), span / size);
        if (size >= units_differ / 10 * span)
            return asked(named(body) + " is far larger than the box", size / span);
        if (domain.size.surface >= units_differ / 10 * size)
            return asked("size.surface is far larger than " + named(body), domain.size.surface / size);
    }
    return "";
}

void warn(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) fmt::print(stderr, "kropla: warning: {}\n", warning);
}

std::vector<std::string> foresee(const Case& given, const Watch* watch) {
    const Domain& domain = given.domain;
    const double doubtful = doubtful_gap(given.quality.max_aspect_ratio);
    try {
        (void)surface_limit(domain, 0, least_gap_in_sizes);
    } catch (const DomainError& error) {
        throw DomainError(error.what() + unit_hint(domain));
    }
    check_layers(domain, 0);
    const Allowed all = look_at_all(given, watch);
    std::vector<std::string> warnings;
    for (const Parameter& parameter : given.parameters)
        if (!parameter.used) warnings.push_back(fmt::format("parameters.{} is used by no expression", parameter.name));
    for (const Approach& gap : all.seen.closest) {
        check_layer_gap(domain, gap);
        const double needed =
            neediest_layer(domain, gap) != nullptr ? doubtful / (1 - share_of_gap) : doubtful;
        if (size_for_gap(domain, gap, needed) < finest(domain, gap))
            warnings.push_back(doubt(given, gap, needed));
    }
    check_sizes(given, all.limit, watch);
    check_start(given);
    check_cut_bodies(given, watch);
    if (given.mesh) warnings.insert(warnings.end(), given.mesh->notes.begin(), given.mesh->notes.end());
    else if (const std::string thin = thin_box(domain); !thin.empty()) warnings.push_back(thin);
    if (domain.size.growth > steepest_growth)
        warnings.push_back(fmt::format("size.growth = {} counts as {}: steeper sizes leave cells above the limit",
                                       domain.size.growth, steepest_growth));
    for (const std::size_t body : all.seen.too_fast)
        warnings.push_back(
            named(domain.bodies[body]) +
            ": its motion goes to and fro faster than the steps; not all of its path was looked at");
    return warnings;
}

}  // namespace kropla
