#include "report/results.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace kropla {
namespace {

constexpr std::array<const char*, 6> face_names = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

double largest_size(const std::vector<double>& values) {
    double most = 0;
    for (const double value : values) most = std::max(most, std::abs(value));
    return most;
}

double integral(const std::vector<double>& per_second, const std::vector<double>& dt) {
    return std::inner_product(per_second.begin(), per_second.end(), dt.begin(), 0.0);
}

/// Three columns with the components of a vector.
std::vector<Vec3> vectors(const Table& table, const std::string& x, const std::string& y, const std::string& z) {
    const auto xs = numbers(table, x), ys = numbers(table, y), zs = numbers(table, z);
    std::vector<Vec3> all;
    for (std::size_t i = 0; i < xs.size(); ++i) all.push_back({xs[i], ys[i], zs[i]});
    return all;
}

BodyResult body_result(const Table& steps, const std::string& name, const std::vector<double>& dt) {
    BodyResult body{.name = name,
                    .place = vectors(steps, "x_" + name, "y_" + name, "z_" + name),
                    .velocity = vectors(steps, "u_" + name, "v_" + name, "w_" + name),
                    .volume = numbers(steps, "volume_" + name)};
    body.start_place = body.place.front();
    if (has_column(steps, "force_x_" + name)) {
        body.force = vectors(steps, "force_x_" + name, "force_y_" + name, "force_z_" + name);
        body.spin = vectors(steps, "spin_x_" + name, "spin_y_" + name, "spin_z_" + name);
    }
    if (has_column(steps, "gap_" + name)) {
        body.gap = numbers(steps, "gap_" + name);
        body.contact_force =
            vectors(steps, "contact_force_x_" + name, "contact_force_y_" + name, "contact_force_z_" + name);
    }
    if (!has_column(steps, "temperature_mean_" + name)) return body;
    body.coldest = numbers(steps, "temperature_min_" + name);
    body.mean = numbers(steps, "temperature_mean_" + name);
    body.hottest = numbers(steps, "temperature_max_" + name);
    body.heat_from = numbers(steps, "heat_from_" + name);
    body.given_off = integral(body.heat_from, dt);
    body.start_mean = body.mean.front();
    body.least = *std::ranges::min_element(body.coldest);
    body.most = *std::ranges::max_element(body.hottest);
    return body;
}

std::vector<BodyResult> bodies_of(const Table& steps, const std::vector<double>& dt) {
    constexpr std::string_view volume = "volume_";
    std::vector<BodyResult> bodies;
    for (const Column& column : steps.columns)
        if (column.name.starts_with(volume) && column.unit == "m^3")
            bodies.push_back(body_result(steps, column.name.substr(volume.size()), dt));
    return bodies;
}

/// Puts in what bodies.csv tells of the start. Returns whether it does.
bool add_start(const Table& table, std::vector<BodyResult>& bodies) {
    if (table.rows != bodies.size() || !has_column(table, "x")) return false;
    const std::vector<Vec3> places = vectors(table, "x", "y", "z");
    const auto name = std::ranges::find(table.columns, "name", &Column::name);
    if (name == table.columns.end()) return false;
    const bool warm = has_column(table, "temperature_mean");
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        BodyResult& body = bodies[i];
        body.start_place = places[i];
        body.name = name->cells[i];
        if (!warm || body.mean.empty()) continue;
        body.start_mean = numbers(table, "temperature_mean")[i];
        body.least = std::min(*body.least, numbers(table, "temperature_min")[i]);
        body.most = std::max(*body.most, numbers(table, "temperature_max")[i]);
    }
    return true;
}

/// What leaves through the faces, by columns that begin so.
std::vector<FaceResult> faces_of(const Table& steps, const std::string& begin,
                                 const std::vector<double>& dt) {
    std::vector<FaceResult> faces;
    for (const char* name : face_names) {
        const std::string column = begin + name;
        if (!has_column(steps, column)) return {};
        FaceResult face{name, numbers(steps, column), 0};
        face.total = integral(face.out, dt);
        faces.push_back(std::move(face));
    }
    return faces;
}

/// The start is what the first step found: what it left, less what it brought and missed.
std::optional<EnergyBalance> energy_of(const Table& steps, const std::vector<FaceResult>& faces,
                                       const std::vector<double>& dt) {
    if (faces.empty() || !has_column(steps, "energy_error")) return {};
    const auto stored = numbers(steps, "energy_integral"), before = numbers(steps, "energy_before_transfer"),
               missed = numbers(steps, "energy_error");
    EnergyBalance balance{.end = stored.back(), .stored = stored};
    double brought_first = 0, passed = 0;
    const auto bring = [&](std::vector<double> power) {
        brought_first += power.front() * dt.front();
        for (double& watts : power) watts = std::abs(watts);
        passed = std::max(passed, integral(power, dt));
    };
    for (const FaceResult& face : faces) {
        balance.faces -= face.total;
        std::vector<double> in = face.out;
        for (double& watts : in) watts = -watts;
        bring(in);
    }
    for (const auto& [column, total] : {std::pair{"heat_sources", &balance.sources},
                                        {"heat_at_surfaces", &balance.surfaces},
                                        {"heat_held", &balance.held},
                                        {"heat_by_volume", &balance.expansion}}) {
        if (total == &balance.expansion && !has_column(steps, column)) continue;  // a run of an older version
        const std::vector<double> power = numbers(steps, column);
        *total = integral(power, dt);
        bring(power);
    }
    balance.start = before.front() - missed.front() - brought_first;
    balance.size = std::max({std::abs(balance.start), largest_size(stored), passed});
    return balance;
}

/// The mass of what flows, where density and box are numbers of the case.
std::optional<double> mass_of_flow(const RunFiles& run, const std::vector<BodyResult>& bodies) {
    const auto density = number_of_case(run.case_text, "flow.region.\"surroundings\"", "density");
    const auto min = vector_of_case(run.case_text, "domain", "min"),
               max = vector_of_case(run.case_text, "domain", "max");
    if (!density || !min || !max) return {};
    const Vec3 box = *max - *min;
    double volume = box.x * box.y * box.z;
    for (const BodyResult& body : bodies) volume -= body.volume.front();
    return *density * volume;
}

std::optional<FlowResult> flow_of(const RunFiles& run, const std::vector<BodyResult>& bodies,
                                  const std::vector<double>& dt) {
    const Table& steps = run.steps;
    if (!has_column(steps, "courant")) return {};
    FlowResult flow{.faces = faces_of(steps, "volume_out_", dt),
                    .courant = numbers(steps, "courant"),
                    .passes = numbers(steps, "flow_passes"),
                    .iterations = numbers(steps, "flow_iterations"),
                    .rounds = numbers(steps, "flow_rounds"),
                    .mass = mass_of_flow(run, bodies)};
    for (const FaceResult& face : flow.faces)
        flow.flux_size = std::max(flow.flux_size, largest_size(face.out));
    for (const BodyResult& body : bodies)
        flow.flux_size = std::max(flow.flux_size, largest_size(sizes(body.velocity)) *
                                                      std::pow(std::cbrt(std::abs(body.volume.front())), 2));
    for (const double missed : numbers(steps, "mass_error_surroundings"))
        flow.mass_missed += std::abs(missed);
    return flow;
}

}  // namespace

double length_scale(const BodyResult& body) {
    double size = body.volume.empty() ? 0 : std::cbrt(std::abs(body.volume.front()));
    const auto include = [&](const Vec3& p) { size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)}); };
    include(body.start_place);
    for (const Vec3& place : body.place) include(place);
    return size;
}

bool moves(const BodyResult& body) {
    return std::ranges::any_of(body.place, [&](const Vec3& place) {
        return !is_rounding(distance(place, body.start_place), length_scale(body));
    });
}

bool is_rounding(double value, double size) { return std::abs(value) <= rounding_share * std::abs(size); }

std::vector<int> notable_axes(const std::vector<Vec3>& vectors) {
    Vec3 most;
    for (const Vec3& vector : vectors)
        for (int axis = 0; axis < 3; ++axis) most[axis] = std::max(most[axis], std::abs(vector[axis]));
    const double largest = std::max({most.x, most.y, most.z});
    std::vector<int> axes;
    for (int axis = 0; axis < 3; ++axis)
        if (most[axis] > notable_share * largest) axes.push_back(axis);
    return axes;
}

std::vector<double> sizes(const std::vector<Vec3>& vectors) {
    std::vector<double> all;
    for (const Vec3& vector : vectors) all.push_back(norm(vector));
    return all;
}

bool turns(const BodyResult& body) {
    const double radius = body.volume.empty() ? 0 : 0.5 * std::cbrt(std::abs(body.volume.front()));
    const double turning = radius * largest_size(sizes(body.spin)),
                 going = largest_size(sizes(body.velocity));
    return turning > notable_share * going;
}

RunResults results_of(const RunFiles& run) {
    RunResults results;
    if (run.steps.rows == 0) return results;
    results.time = numbers(run.steps, "time");
    const std::vector<double> dt = numbers(run.steps, "dt");
    results.bodies = bodies_of(run.steps, dt);
    results.start_known = run.bodies && add_start(*run.bodies, results.bodies);
    results.faces = faces_of(run.steps, "heat_out_", dt);
    results.energy = energy_of(run.steps, results.faces, dt);
    results.flow = flow_of(run, results.bodies, dt);
    if (has_column(run.steps, "contacts")) results.contacts = numbers(run.steps, "contacts");
    return results;
}

}  // namespace kropla
