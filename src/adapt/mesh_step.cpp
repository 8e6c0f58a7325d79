#include "adapt/mesh_step.h"

#include "adapt/constants.h"
#include "adapt/paper.h"
#include "adapt/way.h"
#include "base/checks.h"
#include "generate/layers.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace kropla {
namespace {

/// The vertices of a body's tets and of its layers' columns, in order.
std::vector<Vertex> vertices_of(const Mesh& mesh, Region region) {
    std::vector<Vertex> vertices;
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t) && mesh.region[t] == region)
            vertices.insert(vertices.end(), mesh.tets[t].begin(), mesh.tets[t].end());
    for (const PrismLayer& layer : mesh.layers)
        if (layer.body == region) vertices.insert(vertices.end(), layer.columns.begin(), layer.columns.end());
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

/// The cells of bodies at the shells of layers inside of them, where these bodies move rigidly: no zone has them.
std::vector<Tet> cells_at_inner_shells(const Mesh& mesh, const Domain& domain) {
    IndexSet<Tet> cells;
    for (const PrismLayer& layer : mesh.layers) {
        if (layer.region != layer.body || domain.bodies[as_size(layer.body.value - 1)].deformation) continue;
        for (int column = 0; column < count_columns(layer); ++column)
            for (Tet t : ball(mesh, column_vertex(layer, column, layer.count))) cells.insert(t);
    }
    return cells.list();
}

/// Of the cells that are new, and of those with a vertex that was moved.
double worst_aspect_ratio_of(const Mesh& mesh, const Changes& changes) {
    std::vector<Tet> cells, around;
    std::ranges::copy_if(changes.cells, std::back_inserter(cells), [&](Tet t) { return alive(mesh, t); });
    for (Vertex v : changes.vertices) {
        if (!alive(mesh, v)) continue;
        ball(mesh, v, around);
        cells.insert(cells.end(), around.begin(), around.end());
    }
    return worst_aspect_ratio(mesh, cells);
}

/// Within so many target sizes of one of the places.
std::vector<Tet> cells_near(const Mesh& mesh, std::span<const Vec3> places, double sizes, const Snapshot& at_time) {
    std::vector<Tet> cells;
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t) || mesh.region[t] != surroundings) continue;
        const Vec3 x = centroid(mesh, t);
        if (std::ranges::any_of(places, [&](const Vec3& p) {
                return distance(p, x) < sizes * target_size(at_time, p);
            }))
            cells.push_back(t);
    }
    return cells;
}

/// In developer and debug builds: throws std::logic_error, which nobody catches, if a step leaves what is no mesh.
void look_again(const Mesh& mesh, const char* which) {
    if constexpr (checks)
        if (const std::string fault = verify(mesh); !fault.empty())
            throw std::logic_error(std::string("A step leaves the ") + which + " mesh with " + fault);
}

}  // namespace

MeshStep::MeshStep(Domain domain, PlannedMotions planned, Mesh mesh, double t, const AdaptOptions& options)
    : domain_(std::move(domain)), planned_(std::move(planned)), options_(options),
      reference_(std::move(mesh)), before_(reference_), current_(reference_), time_(t), target_time_(t) {
    for (std::size_t body = 0; body < domain_.bodies.size(); ++body)
        bodies_.vertices.push_back(vertices_of(reference_, region_of_body(body)));
    bodies_.surroundings = options.paper ? Follow::rest : Follow::spread;
    find_deforming();
    find_uneven();
    at_inner_shells_ = cells_at_inner_shells(reference_, domain_);
}

Snapshot MeshStep::snapshot_at(double t) const {
    return snapshot(domain_, t, bodies_.deforming, current_.position, bodies_.uneven);
}

void MeshStep::end_attempt() noexcept {
    for (auto& [body, told] : told_) std::swap(domain_.bodies[body].motion, told.before);
    forget_told();
    under_way_ = false;
}

void MeshStep::forget_told() noexcept {
    told_.clear();
    for (auto& [body, deformation] : not_told_) std::swap(domain_.bodies[body].deformation, deformation);
    not_told_.clear();
}

void MeshStep::begin_step() {
    if (std::exchange(dropped_, false)) {
        current_ = before_ = reference_;
        zone_ = {};
        motion_ = {};
    }
    const auto replaced = replaced_.list();
    for (Mesh* mesh : {&current_, &before_}) copy_changed(*mesh, reference_, replaced, moved_);
    follow(zone_, current_, replaced_);
    begin_motion(motion_);
    replaced_.clear();
    moved_.clear();
    refined_.clear();
    adapted_.clear();
    way_ = {};
    stuck_.reset();
    statistics_ = {};
}

const Changes& MeshStep::refine() {
    Changes& changes = statistics_.refined;
    heed(options_.watch);
    if (trouble_.empty()) return changes;
    changes = options_.paper ? refine_by_paper() : refine_by_size();
    note_replaced(changes);
    copy_changed(before_, current_, replaced_.list(), changes.vertices);
    follow(zone_, current_, replaced_);
    refined_ = changes.cells;
    return changes;
}

/// Near the places of trouble, at the step's beginning.
Changes MeshStep::refine_by_size() {
    const Snapshot at_time = snapshot_at(time_);
    AdaptOptions options = options_;
    options.good_enough = std::max(least_good_enough, stricter * options_.good_enough);
    auto cells = cells_near(current_, trouble_, trouble_in_sizes, at_time);
    Changes changes = adapt_to_size(current_, cells, at_time, options);
    cells.insert(cells.end(), changes.cells.begin(), changes.cells.end());
    changes += improve(current_, cells, at_time, options);
    if (trouble_.size() > 1) {  // it was not enough the last time
        options.floor = std::min(options_.floor, trouble_floor);
        options.largest_ring = std::min(options_.largest_ring, rings_of_trouble);
        options.whole_region = false;
        changes += repair(current_, cells_near(current_, trouble_, trouble_in_sizes, at_time), at_time, options);
    }
    return changes;
}

/// The same by clusters, in a part of the domain that grows with the refusals; the whole region at last.
Changes MeshStep::refine_by_paper() {
    const Snapshot at_time = snapshot_at(time_);
    AdaptOptions options = options_;
    options.whole_region = false;
    options.cut_out = cut_out_of_trouble;
    if (trouble_.size() >= refusals_until_all_anew) {
        const auto cavity = cluster_remesh(current_, all_tets(current_, surroundings), at_time, options);
        if (cavity && cavity->worst_after <= about_the_limit(options_)) {
            Changes changes;
            carry_out(current_, *cavity, changes);
            ++changes.global_remeshes;
            return changes;
        }
    }
    const auto cells = cells_near(current_, trouble_, static_cast<double>(trouble_.size()) * trouble_in_sizes, at_time);
    return remesh_clusters(current_, cells, std::min(options_.floor, trouble_floor), at_time, options);
}

void MeshStep::move_boundary() {
    heed(options_.watch);
    const double t = target_time_;
    stuck_ = turned_too_far();
    if (stuck_) return;
    statistics_.legs = 1;
    place_boundary(current_, domain_, bodies_, time_, t, zone_, motion_);
    write_places(motion_, current_);
    note_moved();
}

void MeshStep::correct(std::span<const BodyPlace> places, std::span<const BodyCourse> courses) {
    for (const auto& [body, pose] : places) {
        if (body >= planned_.motion.size()) throw std::logic_error("a body is told its place that the domain has not");
        const CorrectedStep step{planned_.corrected[body].to, correction(planned_.motion[body](target_time_), pose), time_, target_time_};
        const auto known = told_.try_emplace(body, Told{step, domain_.bodies[body].motion}).first;
        known->second.step = step;
        domain_.bodies[body].motion = corrected(planned_.motion[body], step);
    }
    for (const auto& [body, deformation] : courses) {
        if (body >= domain_.bodies.size() || !domain_.bodies[body].deformation || !deformation)
            throw std::logic_error("a body is told how it deforms that does not");
        not_told_.try_emplace(body, domain_.bodies[body].deformation);
        domain_.bodies[body].deformation = deformation;
    }
    if (places.empty() && courses.empty()) return;
    copy_changed(current_, before_, {}, moved_);
    way_ = {};
}

void MeshStep::optimise() {
    if (stuck_) return;
    if (optimise_placed()) way_ = check_way(motion_, current_, before_.position, least_volume_kept);
    if (!way_.arrived) move_in_legs();
    if (!stuck_) stuck_ = what_limits();
}

/// Goes as far as all cells stay valid, optimises the places there, and so on.
void MeshStep::move_in_legs() {
    copy_changed(current_, before_, {}, moved_);
    double here = time_;
    for (int leg = 1; leg <= most_legs; ++leg) {
        heed(options_.watch);
        statistics_.legs = leg;
        const auto move_to = [&](double t) {
            return kropla::move_boundary(current_, domain_, bodies_, here, t, zone_, motion_);
        };
        const MoveReport report = move_to(target_time_);
        const double share = report.arrived ? 1 : share_of_safe * report.fraction;
        const double next = report.arrived ? target_time_ : here + share * (target_time_ - here);
        if (!report.arrived) {
            stuck_ = refused(report.limiting, "keeps the bodies from arriving", here - time_);
            if (share < least_leg) return;
            if (!move_to(next).arrived) return;
        }
        note_moved();
        if (!optimise_placed()) return note_turned_over(here);
        here = next;
        if (!report.arrived) continue;
        stuck_.reset();
        way_ = check_way(motion_, current_, before_.position, least_volume_kept);
        return;
    }
}

/// The places that were moved have a cell that is turned over.
void MeshStep::note_turned_over(double reached) {
    const auto is_turned = [&](Tet t) { return !std::isfinite(motion_.ratio[t]); };
    const auto cell = std::ranges::find_if(motion_.cells, is_turned);
    const Tet limiting = cell == motion_.cells.end() ? motion_.cells.front() : *cell;
    stuck_ = refused(limiting, "would be turned over", reached - time_);
}

/// Returns false if a cell is turned over.
bool MeshStep::optimise_placed() {
    const auto changes = options_.paper ? smooth_places(zone_, motion_, current_, options_)
                                        : optimise_places(zone_, motion_, current_, options_);
    if (!changes) return false;
    statistics_.optimised += *changes;
    write_places(motion_, current_);
    return true;
}

std::optional<Refusal> MeshStep::refusal() const {
    auto refusal = stuck_;
    if (refusal && statistics_.refined.given_up > 0)
        refusal->why += "; the effort allowed for remeshing there was spent";
    return refusal;
}

std::optional<Refusal> MeshStep::what_limits() const {
    if (auto gap = narrow_gap()) return gap;
    if (auto cell = worst_cell()) return cell;
    if (auto prism = squeezed_prism()) return prism;
    return turned_on_its_way();
}

/// A body whose cells would all but vanish half-way of a large turn.
std::optional<Refusal> MeshStep::turned_too_far() const {
    for (const Body& body : domain_.bodies) {
        const double kept = volume_kept_turning(shape_at(body, time_), shape_at(body, target_time_));
        if (kept >= least_volume_kept) continue;
        const double turn = std::acos(std::max(-1.0, 2 * kept - 1)), most = std::acos(2 * least_volume_kept - 1);
        const double advised_dt = most / turn * (target_time_ - time_);
        const auto degrees = [](double angle) { return written(angle * 180 / std::numbers::pi); };
        return Refusal{.why = "at t = " + time_words(target_time_) + ' ' + named(body) + " would have turned by " +
                              degrees(turn) + " degrees in one step, at most " + degrees(most) +
                              " are possible: a step of " + time_words(advised_dt) + " would do",
                       .limiting = {},
                       .advised_dt = advised_dt,
                       .place = shape_at(body, target_time_).centre,
                       .time = target_time_};
    }
    return std::nullopt;
}

/// A cell that does not keep its volume all along its way, though it does in the end.
std::optional<Refusal> MeshStep::turned_on_its_way() const {
    constexpr const char* fault = "would be turned inside out on its way";
    const double dt = target_time_ - time_;
    if (!way_.arrived) return refused(way_.limiting, fault, way_.fraction * dt);
    for (Tet t : at_inner_shells_)
        if (const double safe = safe_fraction(current_, {&t, 1}, before_.position, current_.position, least_volume_kept);
            safe < 1)
            return refused(t, fault, safe * dt);
    for (const Prism& prism : all_prisms(current_)) {
        const auto from = prism_corners(before_, prism);
        const double safe = safe_fraction(from, prism_corners(current_, prism), least_volume_kept);
        if (safe == 1) continue;
        return explained(domain_, {fault, Tet{}, from[0], time_, target_time_, options_.floor}, safe * dt);
    }
    return std::nullopt;
}

Refusal MeshStep::refused(Tet cell, const std::string& fault, double advised_dt) const {
    return explained(domain_, {fault, cell, centroid(current_, cell), time_, target_time_, options_.floor}, advised_dt);
}

std::optional<Refusal> MeshStep::narrow_gap() const {
    const auto gap = narrowest_gap(current_, snapshot_at(target_time_));
    if (!gap || gap->distance >= gap->allowed) return std::nullopt;
    const Approach near{gap->body, gap->wall, gap->other, std::max(0.0, gap->distance), target_time_};
    const std::string advice = near.gap > 0 ? "; at most " + metres(rounded_down(near.gap)) + " would do" : "";
    return Refusal{"at t = " + time_words(target_time_) + ' ' + in_words(domain_, near) + " at " +
                       place_words(gap->place) + ", less than layer.min_gap = " + metres(gap->allowed) + advice,
                   Tet{}, time_until_gap(domain_, near, time_, target_time_, gap->allowed), gap->place,
                   target_time_, near};
}

std::optional<Refusal> MeshStep::worst_cell() const {
    Tet limiting;
    double worst = options_.floor;
    const auto look_at = [&](Tet t, double ratio) {
        if (ratio <= worst) return;
        worst = ratio;
        limiting = t;
    };
    for (Tet t : motion_.cells) look_at(t, motion_.ratio[t]);
    for (Tet t : at_inner_shells_) look_at(t, aspect_ratio(current_, t));
    for (Tet t : refined_)
        if (alive(current_, t)) look_at(t, aspect_ratio(current_, t));
    if (!limiting.exists()) return std::nullopt;
    const double was = aspect_ratio(before_, limiting);
    const double share = was < options_.floor ? (options_.floor - was) / (worst - was) : 0;
    char fault[80];
    std::snprintf(fault, sizeof fault, "would have R/r %.4g, limit %.4g", worst, options_.floor);
    return refused(limiting, fault, share * (target_time_ - time_));
}

std::optional<Refusal> MeshStep::squeezed_prism() const {
    for (const Prism& prism : all_prisms(current_)) {
        const auto corners = prism_corners(current_, prism);
        const double jacobian = scaled_corner_jacobian(corners);
        if (jacobian >= least_jacobian) continue;
        char fault[80];
        std::snprintf(fault, sizeof fault, "would have a scaled Jacobian of %.3g, limit %.3g", jacobian,
                      least_jacobian);
        const double was = scaled_corner_jacobian(prism_corners(before_, prism));
        const double share = was > least_jacobian ? (was - least_jacobian) / (was - jacobian) : 0;
        return explained(domain_, {fault, Tet{}, corners[0], time_, target_time_, options_.floor},
                         share * (target_time_ - time_));
    }
    return std::nullopt;
}

void MeshStep::refuse() {
    if (const auto reason = refusal(); reason && reason->limiting.exists())
        trouble_.push_back(centroid(before_, reason->limiting));
}

/// What smoothing leaves about the limit. No cell comes to be above it.
Changes MeshStep::remesh_by_paper() {
    AdaptOptions options = options_;
    options.whole_region = false;  // what meets the floor is not worth it
    return remesh_clusters(current_, cells_above(options_.swap_above), about_the_limit(options_),
                           snapshot_at(target_time_), options);
}

Changes MeshStep::remesh_by_size(const AdaptOptions& options) {
    const Snapshot at_time = snapshot_at(target_time_);
    Changes changes = adapt_to_size(current_, zone_, motion_, at_time, options);
    changes += swap_for_energy(current_, cells_above(options.swap_above), options, false);
    std::vector<Tet> poor = cells_above(options.good_enough);
    adapted_ = surfaces_to_adapt(at_time);
    adapt_surfaces(at_time, options, changes);
    poor.insert(poor.end(), changes.cells.begin(), changes.cells.end());
    changes += improve(current_, poor, at_time, options, changes.cells);
    improve_surfaces(poor, at_time, options, changes);
    changes += repair(current_, changes.cells, at_time, options);
    return changes;
}

const Changes& MeshStep::remesh() {
    copy_changed(before_, current_, {}, moved_);
    Changes& changes = statistics_.remeshed;
    changes = options_.paper ? remesh_by_paper() : remesh_by_size(options_);
    if (!options_.paper && worst_aspect_ratio_of(current_, changes) > options_.floor) {
        // What passed the floor on its way stayed there: taken back, and done again without passing it.
        statistics_.redone = true;
        note_replaced(changes);
        copy_changed(current_, before_, replaced_.list(), moved_);
        AdaptOptions options = options_;
        options.passing = std::min(options.passing, options.floor);
        changes = remesh_by_size(options);
    }
    note_replaced(changes);
    statistics_.cells_touched = static_cast<int>(motion_.cells.size());
    return changes;
}

void MeshStep::accept() {
    copy_changed(reference_, current_, replaced_.list(), moved_);
    for (const auto& [body, told] : told_) planned_.corrected[body] = told.step;
    forget_told();
    time_ = target_time_;
    trouble_.clear();
    const auto adapted = std::exchange(adapted_, {});
    for (const BodySurface& surface : adapted)
        bodies_.vertices[surface.body] = vertices_of(reference_, region_of_body(surface.body));
    find_deforming();
    if (!adapted.empty()) find_uneven();
    look_again(before_, "moved");
    look_again(reference_, "adapted");
}

/// The cells that the step has made worse than `ratio`, or has left so.
std::vector<Tet> MeshStep::cells_above(double ratio) const {
    std::vector<Tet> cells;
    std::ranges::copy_if(motion_.cells, std::back_inserter(cells), [&](Tet t) { return motion_.ratio[t] > ratio; });
    return cells;
}

void MeshStep::note_moved() {
    moved_.insert(moved_.end(), motion_.bodies.begin(), motion_.bodies.end());
    moved_.insert(moved_.end(), motion_.vertices.begin(), motion_.vertices.end());
}

void MeshStep::note_replaced(const Changes& changes) {
    for (Tet t : changes.cells) replaced_.insert(t);
    for (Tet t : changes.removed) replaced_.insert(t);
    moved_.insert(moved_.end(), changes.vertices.begin(), changes.vertices.end());
}

}  // namespace kropla
