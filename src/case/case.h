#pragma once

#include <kropla/adapt/adapt.h>
#include <kropla/base/error.h>
#include <kropla/domain/domain.h>
#include <kropla/simulate/flow.h>
#include <kropla/simulate/heat.h>
#include "motion/contact.h"
#include "motion/rigid_motion.h"
#include <kropla/simulate/species.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kropla {

/// What no accepted step may exceed, and how the mesh is kept so.
struct QualityPlan {
    double max_aspect_ratio = 10;  // [-] R/r, at least 5; 3 is a perfect tet
    std::optional<PaperMethod> paper = {};  // the paper's own way; nothing: ours
};

struct TimePlan {
    double end = 0;  // [s], positive
    int steps = 1;   // wanted, at least 1; a step may be cut, the sum is kept
    std::optional<double> courant = {};  // [-] if given, steps are cut so that the flow crosses no more heights of cells
};

struct OutputPlan {
    int every = 1;  // [-] steps between frames, at least 1
};

struct RandomSeed {
    std::uint64_t seed = 1;
};

/// A name for expressions to use.
struct Parameter {
    std::string name;
    double value = 0;
    bool used = false;  // by an expression of the case
};

/// Keys and their values, as a TOML value is written: `300`, `"-1.0*t"`, `{ flux = 1e4 }`.
using WrittenKeys = std::vector<std::pair<std::string, std::string>>;

/// How the user put what the structs of a case hold in another form, each as a TOML value. Empty: not given.
struct WrittenBody {
    std::string shape;  // as the case names it, without quotes
    std::string region = {};  // of the mesh that the case brings, as TOML
    std::string rotation;
    WrittenKeys surface;                // of a surface, a slab or a cylinder: where it comes from
    std::array<std::string, 3> motion;  // all empty: at rest, or not by a path
    WrittenKeys free;                   // its motion, if it goes where forces take it
    std::string velocity;               // of its surface, if it deforms; else empty
    std::string angle, axis;            // of the motion; both empty: it does not turn
};
struct WrittenHeat {
    std::vector<WrittenKeys> regions;   // per region
    std::vector<WrittenKeys> surfaces;  // per body
    std::array<std::string, 6> faces;   // per face of the box
};
struct WrittenFlow {
    WrittenKeys general;
    std::vector<WrittenKeys> regions;  // per region
    std::vector<WrittenKeys> surfaces;  // per body
    std::array<std::string, 6> faces;  // per face of the box
};
struct WrittenSpecies {
    std::vector<WrittenKeys> regions;   // per region
    std::vector<WrittenKeys> surfaces;  // per body
    WrittenKeys faces;
};

/// A mesh from elsewhere, in place of one that is made.
struct BroughtMesh {
    std::string file;                  // absolute
    std::shared_ptr<const Mesh> mesh;  // region i + 1 is body i, as in the domain; not improved yet
    std::vector<std::string> notes;    // what was mended when it was read
    std::map<std::string, Patch> faces = {};  // of named patches that are a face of the box; of others, none
};

/// What flows, and how it begins.
struct FlowPlan {
    FlowOptions options;
    std::vector<VectorQuantity> initial;  // [m/s] per region
};

/// All that a run is told, SI units.
struct Case {
    Domain domain;
    std::optional<BroughtMesh> mesh;  // nothing: it is made for the domain
    QualityPlan quality;
    TimePlan time;
    std::optional<HeatOptions> heat;  // nothing: the mesh moves, nothing is simulated
    std::vector<Species> species;
    std::optional<FlowPlan> flow;  // nothing: the surroundings rest, but for making way
    std::vector<std::optional<FreeMotion>> free;  // per body: goes where forces take it
    std::vector<char> liquid;      // per body: goes with the flow, on both sides of its surface
    std::optional<ContactOptions> contact;  // of free bodies; nothing: the run ends where the mesh cannot follow them
    OutputPlan output;
    RandomSeed random;

    std::vector<WrittenBody> written_bodies;  // per body
    WrittenHeat written_heat;
    std::vector<WrittenSpecies> written_species;
    WrittenFlow written_flow;
    std::vector<Parameter> parameters;
    std::map<std::string, std::string> written_numbers;  // by full key, as TOML: those that are expressions of parameters
};

/// What a case file names as a body's surface bounds nothing. Beside the words, the triangles of the file [m], and the
/// numbers of those at fault; none where it is not theirs.
struct SurfaceFileError : CaseError {
    SurfaceFileError(const std::string& what, std::vector<Vec3> all, std::vector<std::array<int, 3>> of,
                     std::vector<std::size_t> at_fault)
        : CaseError(what), points(std::move(all)), triangles(std::move(of)), faulty(std::move(at_fault)) {}
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::size_t> faulty;
};

/// The most tets that a case may ask for: beyond, a run would take days and the memory of a large machine.
inline constexpr double most_tets = 2e7;

/// Reads a case file (TOML; its keys are explained in docs and in what `kropla new` writes).
/// `settings`, each "key=value", replace values of it (case/setting.h).
/// Throws FileError if the file cannot be read, and CaseError, naming file or setting, key, line, value and what would
/// be right, if anything in it is wrong, missing or unknown. Whether bodies and sizes fit is asked by `foresee`.
[[nodiscard]] Case read_case(const std::filesystem::path& path, std::span<const std::string> settings = {});
/// As above, from the text itself; `name` stands for the file in refusals.
[[nodiscard]] Case parse_case(std::string_view text, const std::string& name, std::span<const std::string> settings = {});

/// The case as it is run, defaults filled in, as a case file that reads as the same case again.
[[nodiscard]] std::string to_toml(const Case& given);

/// Is a body solid and at rest, and reaches through faces of the box?
[[nodiscard]] bool rests_on_faces(const Case& given, std::size_t body);

/// About how many tets the domain's mesh will have at t = 0: the integral of the size field's tets per
/// volume.
[[nodiscard]] double estimate_tets(const Domain& domain);

}  // namespace kropla
