// Closed surfaces of triangles that are changed by splits, flips and collapses.
//
// The conditions of a collapse are those of [Dey, Edelsbrunner, Guha, Nekhayev 1999, "Topology preserving edge
// contraction"]: the two vertices have no neighbours in common but the corners opposite their edge.

#include "generate/sheet.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kropla {

namespace {

void join(Sheet& sheet, Half a, Half b) {
    sheet.twin[a] = b;
    sheet.twin[b] = a;
}

/// Half-edges that are one edge, by their ends.
void join_twins(Sheet& sheet) {
    struct Ends {
        Vertex low, high;
        Half half;
    };
    std::vector<Ends> all;
    all.reserve(sheet.origin.size());
    for (Half h : sheet.origin.indices()) {
        const auto [low, high] = std::minmax({sheet.origin[h], sheet.target(h)});
        all.push_back({low, high, h});
    }
    std::ranges::sort(all, {}, [](const Ends& e) { return std::tuple(e.low, e.high, e.half); });
    for (std::size_t i = 0; i + 1 < all.size(); i += 2) join(sheet, all[i].half, all[i + 1].half);
}

}  // namespace

Sheet make_sheet(const Surface& surface) {
    Sheet sheet;
    for (const Vec3& x : surface.points) sheet.place.push_back(x);
    sheet.hold.resize(surface.points.size(), Sheet::Hold::none);
    sheet.leaving.resize(surface.points.size());
    for (const auto& triangle : surface.triangles)
        for (int corner : triangle) sheet.leaving[Vertex(corner)] = sheet.origin.push_back(Vertex(corner));
    sheet.twin.resize(sheet.origin.size());
    sheet.crease.resize(sheet.origin.size(), 0);
    join_twins(sheet);
    std::vector<std::array<int, 2>> creases = surface.creases;
    std::ranges::sort(creases);
    for (Half h : sheet.origin.indices()) {
        const auto [low, high] = std::minmax({sheet.origin[h].value, sheet.target(h).value});
        sheet.crease[h] = std::ranges::binary_search(creases, std::array{low, high}) ? 1 : 0;
    }
    return sheet;
}

Surface surface_of(const Sheet& whole) {
    const Sheet sheet = compacted(whole);
    Surface surface;
    surface.points.assign(sheet.place.begin(), sheet.place.end());
    for (Half h : sheet.origin.indices()) {
        const int from = sheet.origin[h].value, to = sheet.target(h).value;
        if (h.value % 3 == 0) surface.triangles.push_back({from, to, sheet.apex(h).value});
        if (sheet.crease[h] != 0 && from < to) surface.creases.push_back({from, to});
    }
    return surface;
}

Vec3 normal_area(const Sheet& sheet, Half h) {
    const Vec3 a = sheet.place[sheet.origin[h]];
    return cross(sheet.place[sheet.target(h)] - a, sheet.place[sheet.apex(h)] - a);
}

Vec3 normal_area(const Sheet& sheet, Half h, Vertex moved, const Vec3& to) {
    const auto place = [&](Vertex v) { return v == moved ? to : sheet.place[v]; };
    const Vec3 a = place(sheet.origin[h]);
    return cross(place(sheet.target(h)) - a, place(sheet.apex(h)) - a);
}

Vertex split_edge(Sheet& sheet, Half h, const Vec3& place) {
    // bca becomes bma and mca; of its twin, cbd becomes cmd and mbd.
    const Half t = sheet.twin[h];
    const Vertex b = sheet.origin[h], c = sheet.origin[t], a = sheet.apex(h), d = sheet.apex(t);
    const Half beyond_ca = sheet.twin[next(h)], beyond_bd = sheet.twin[next(t)];
    const char crease = sheet.crease[h], crease_ca = sheet.crease[next(h)], crease_bd = sheet.crease[next(t)];
    const Vertex m = sheet.place.push_back(place);
    sheet.hold.push_back(crease != 0 ? Sheet::Hold::on_crease : Sheet::Hold::none);
    const Half upper(sheet.origin.size()), lower(sheet.origin.size() + 3);
    for (Vertex v : {m, c, a, m, b, d}) sheet.origin.push_back(v);
    sheet.twin.resize(sheet.origin.size());
    for (char of : {crease, crease_ca, char{0}, crease, crease_bd, char{0}}) sheet.crease.push_back(of);
    sheet.origin[next(h)] = sheet.origin[next(t)] = m;
    sheet.crease[next(h)] = sheet.crease[next(t)] = 0;
    join(sheet, h, lower);
    join(sheet, t, upper);
    join(sheet, next(upper), beyond_ca);
    join(sheet, next(lower), beyond_bd);
    join(sheet, previous(upper), next(h));
    join(sheet, previous(lower), next(t));
    sheet.leaving.push_back(upper);
    sheet.leaving[b] = h;
    sheet.leaving[c] = t;
    return m;
}

bool may_flip(const Sheet& sheet, Half h) {
    if (sheet.crease[h] != 0) return false;
    const Half t = sheet.twin[h];
    const Vertex b = sheet.origin[h], c = sheet.origin[t], a = sheet.apex(h), d = sheet.apex(t);
    const Vec3 out = normal_area(sheet, h) + normal_area(sheet, t), from = sheet.place[a];
    const Vec3 to_b = sheet.place[b] - from, to_c = sheet.place[c] - from, to_d = sheet.place[d] - from;
    for (const Vec3& area : {cross(to_b, to_d), cross(to_d, to_c)})
        if (dot(area, out) <= most_turned * norm(area) * norm(out)) return false;
    bool joined = false;
    for_each_leaving(sheet, a, [&](Half from_a) { joined = joined || sheet.target(from_a) == d; });
    return !joined;
}

void flip_edge(Sheet& sheet, Half h) {
    // bca and cbd become dab and adc.
    const Half t = sheet.twin[h], hn = next(h), hp = previous(h), tn = next(t), tp = previous(t);
    const Vertex b = sheet.origin[h], c = sheet.origin[t], a = sheet.origin[hp], d = sheet.origin[tp];
    const Half ab = sheet.twin[hp], bd = sheet.twin[tn], dc = sheet.twin[tp], ca = sheet.twin[hn];
    const char crease_ab = sheet.crease[hp], crease_bd = sheet.crease[tn], crease_dc = sheet.crease[tp],
               crease_ca = sheet.crease[hn];
    sheet.origin[h] = d, sheet.origin[hn] = a, sheet.origin[hp] = b;
    sheet.origin[t] = a, sheet.origin[tn] = d, sheet.origin[tp] = c;
    join(sheet, hn, ab), join(sheet, hp, bd), join(sheet, tn, dc), join(sheet, tp, ca);
    sheet.crease[hn] = crease_ab, sheet.crease[hp] = crease_bd, sheet.crease[tn] = crease_dc, sheet.crease[tp] = crease_ca;
    sheet.leaving[a] = hn, sheet.leaving[b] = hp, sheet.leaving[d] = tn, sheet.leaving[c] = tp;
}

namespace {

/// Are the two opposite corners all that the ends have in common as neighbours, and stays each with three others?
bool links_meet_in_two(const Sheet& sheet, Half h) {
    const Vertex b = sheet.origin[h], c = sheet.target(h);
    int common = 0, at_a = 0, at_d = 0;
    for_each_leaving(sheet, b, [&](Half from_b) {
        const Vertex v = sheet.target(from_b);
        if (v == c) return;
        for_each_leaving(sheet, c, [&](Half from_c) { common += sheet.target(from_c) == v ? 1 : 0; });
    });
    for_each_leaving(sheet, sheet.apex(h), [&](Half) { ++at_a; });
    for_each_leaving(sheet, sheet.apex(sheet.twin[h]), [&](Half) { ++at_d; });
    return common == 2 && at_a > 3 && at_d > 3;
}

bool holds_let_collapse(const Sheet& sheet, Half h) {
    const Sheet::Hold hold = sheet.hold[sheet.origin[h]];
    if (hold == Sheet::Hold::none) return true;
    if (hold == Sheet::Hold::corner || sheet.crease[h] == 0) return false;
    return sheet.crease[previous(h)] == 0 && sheet.crease[next(sheet.twin[h])] == 0;
}

}  // namespace

bool may_collapse(const Sheet& sheet, Half h, double longest) {
    if (!holds_let_collapse(sheet, h)) return false;
    const Vertex b = sheet.origin[h], c = sheet.target(h);
    const Vec3& to = sheet.place[c];
    bool may = true;
    for_each_leaving(sheet, b, [&](Half from_b) {
        if (!may || sheet.target(from_b) == c) return;
        may = distance(sheet.place[sheet.target(from_b)], to) <= longest;
        if (!may || sheet.apex(from_b) == c) return;
        const Vec3 old = normal_area(sheet, from_b), now = normal_area(sheet, from_b, b, to);
        may = dot(old, now) > most_turned * norm(old) * norm(now);
    });
    return may && links_meet_in_two(sheet, h);
}

void collapse_edge(Sheet& sheet, Half h) {
    const Half t = sheet.twin[h];
    const Vertex b = sheet.origin[h], c = sheet.origin[t], a = sheet.apex(h), d = sheet.apex(t);
    std::vector<Half> from_b;
    for_each_leaving(sheet, b, [&](Half at) { from_b.push_back(at); });
    for (Half at : from_b) sheet.origin[at] = c;
    // The edges ca and ab become one, as do bd and dc.
    const auto close = [&](Half one, Half other) {
        const Half left = sheet.twin[one], right = sheet.twin[other];
        const char crease = sheet.crease[one] != 0 || sheet.crease[other] != 0 ? 1 : 0;
        sheet.crease[left] = sheet.crease[right] = crease;
        join(sheet, left, right);
        return right;
    };
    const Half at_a = close(previous(h), next(h));       // begins at a, as the twin of ca
    const Half from_d = close(next(t), previous(t));     // the twin of dc, which begins at c
    sheet.leaving[a] = at_a;
    sheet.leaving[c] = from_d;
    sheet.leaving[d] = sheet.twin[from_d];
    for (Half dead : {h, next(h), previous(h), t, next(t), previous(t)}) sheet.origin[dead] = {};
    sheet.leaving[b] = {};
}

namespace {

/// The greatest cosine of the triangle's angles: that of the least angle.
double least_angle_cosine(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = normalised(b - a), v = normalised(c - b), w = normalised(a - c);
    return std::max({-dot(u, v), -dot(v, w), -dot(w, u)});
}

bool flip_raises_angle(const Sheet& sheet, Half h) {
    if (sheet.crease[h] != 0) return false;
    const Half t = sheet.twin[h];
    const Vec3 b = sheet.place[sheet.origin[h]], c = sheet.place[sheet.origin[t]], a = sheet.place[sheet.apex(h)],
               d = sheet.place[sheet.apex(t)];
    // Opposite angles of less than pi together: the flip cannot pay in the plane, and hardly on the surface.
    const Vec3 ab = b - a, ac = c - a, db = b - d, dc = c - d;
    if (dot(ab, ac) * norm(cross(db, dc)) + dot(db, dc) * norm(cross(ab, ac)) >= 0) return false;
    return std::max(least_angle_cosine(a, b, d), least_angle_cosine(a, d, c)) <
               std::max(least_angle_cosine(a, b, c), least_angle_cosine(b, d, c)) &&
           may_flip(sheet, h);
}

}  // namespace

void flip_for_angles(Sheet& sheet, const Watch* watch) {
    constexpr int most_rounds = 1000;  // the least angles rise with each flip, but for rounding
    bool changed = true;
    for (int round = 0; changed && round < most_rounds; ++round) {
        heed(watch);
        changed = false;
        for (Half h : sheet.origin.indices()) {
            if (!sheet.alive(h) || !flip_raises_angle(sheet, h)) continue;
            flip_edge(sheet, h);
            changed = true;
        }
    }
}

void flip_for_valences(Sheet& sheet) {
    Array<Vertex, int> excess(sheet.place.size(), -6);
    for (Half h : sheet.origin.indices())
        if (sheet.alive(h)) ++excess[sheet.origin[h]];
    for (Half h : sheet.origin.indices()) {
        if (!sheet.alive(h) || sheet.twin[h] < h) continue;
        const Vertex b = sheet.origin[h], c = sheet.target(h), a = sheet.apex(h), d = sheet.apex(sheet.twin[h]);
        // The sum of squares falls: (e + 1)^2 - e^2 = 2 e + 1 at a and d, (e - 1)^2 - e^2 = 1 - 2 e at b and c.
        if (excess[a] + excess[d] - excess[b] - excess[c] + 2 >= 0 || !may_flip(sheet, h)) continue;
        flip_edge(sheet, h);
        ++excess[a], ++excess[d], --excess[b], --excess[c];
    }
}

Sheet compacted(const Sheet& sheet) {
    Sheet made;
    Array<Vertex, Vertex> number(sheet.place.size());
    for (Vertex v : sheet.place.indices()) {
        if (!sheet.leaving[v].exists()) continue;
        number[v] = made.place.push_back(sheet.place[v]);
        made.hold.push_back(sheet.hold[v]);
    }
    Array<Half, Half> name(sheet.origin.size());
    for (Half h : sheet.origin.indices())
        if (sheet.alive(h)) name[h] = made.origin.push_back(number[sheet.origin[h]]);
    made.twin.resize(made.origin.size());
    made.leaving.resize(made.place.size());
    made.crease.resize(made.origin.size(), 0);
    for (Half h : sheet.origin.indices()) {
        if (!sheet.alive(h)) continue;
        made.twin[name[h]] = name[sheet.twin[h]];
        made.crease[name[h]] = sheet.crease[h];
        made.leaving[made.origin[name[h]]] = name[h];
    }
    return made;
}

}  // namespace kropla
