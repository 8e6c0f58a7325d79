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

std::vector<FaceResult> faces_of(const Table& steps, const std::vector<double>& dt) {
    std::vector<FaceResult> faces;
    for (const char* name : face_names) {
        const std::string column = std::string("heat_out_") + name;
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
                                        {"heat_held", &balance.held}}) {
        const std::vector<double> power = numbers(steps, column);
        *total = integral(power, dt);
        bring(power);
    }
    balance.start = before.front() - missed.front() - brought_first;
    balance.size = std::max({std::abs(balance.start), largest_size(stored), passed});
    return balance;
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

RunResults results_of(const RunFiles& run) {
    RunResults results;
    if (run.steps.rows == 0) return results;
    results.time = numbers(run.steps, "time");
    const std::vector<double> dt = numbers(run.steps, "dt");
    results.bodies = bodies_of(run.steps, dt);
    results.start_known = run.bodies && add_start(*run.bodies, results.bodies);
    results.faces = faces_of(run.steps, dt);
    results.energy = energy_of(run.steps, results.faces, dt);
    return results;
}

}  // namespace kropla
