// The command line: CLI11 reads it; every exception ends here, as one line and an exit code.
#include "app/commands.h"

#include "app/body_sizes.h"
#include "app/check.h"
#include "case/heat.h"
#include "app/check_files.h"
#include "app/command_line.h"
#include "app/first_mesh.h"
#include "case/foresight.h"
#include "app/interrupt.h"
#include "app/mesh_commands.h"
#include "case/new_case.h"
#include "app/progress.h"
#include "app/run.h"
#include "app/step.h"
#include "app/sweep.h"
#include <kropla/base/error.h>
#include <kropla/io/mesh_file.h>
#include <kropla/io/vtk.h>
#include <kropla/mesh/quality.h>
#include "report/page.h"
#include "report/sweep_file.h"
#include "report/sweep_page.h"
#include <kropla/step/initial_mesh.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <system_error>

namespace kropla {
namespace {

struct MeshOptions {
    std::filesystem::path case_file, out;
    std::vector<std::string> settings;
};

/// In VTU with the quality of its cells; in other formats with the names of bodies and faces.
void write_initial(const Case& given, const Mesh& mesh, const std::filesystem::path& out, const Watch* watch) {
    if (out.extension() == ".vtu") return write_vtu(out, mesh, {}, watch);
    Names regions = {{surroundings.value, "surroundings"}}, patches;
    for (std::size_t body = 0; body < given.domain.bodies.size(); ++body)
        regions[region_of_body(body).value] = given.domain.bodies[body].name;
    for (int face = 0; face < box_faces; ++face) patches[face + 1] = face_keys[as_size(face)];
    write_mesh_file(out, cells_of(mesh, std::move(regions), std::move(patches)), watch);
}

/// The initial mesh, written.
Mesh written_mesh_of(const Case& given, const std::filesystem::path& out, Watch& watch) {
    Progress progress;
    if (progress.on_terminal())  // else what is printed is the result alone
        watch.progress = [&](std::string_view stage, double share) { progress.show_stage(stage, share); };
    try {
        warn(foresee(given, &watch));
        Mesh mesh = first_mesh(given, &watch);
        write_initial(given, mesh, out, &watch);
        return mesh;
    } catch (const Interrupted&) {
        throw Interrupted("interrupted while the initial mesh was made; nothing was written");
    }
}

int write_initial_mesh(const MeshOptions& options) {
    if (!is_mesh_file(options.out))
        throw CaseError(fmt::format("{}: is of no format that is known; name a file that ends in {}",
                                    options.out.string(), mesh_extensions));
    Watch watch;
    const CatchInterrupts catching(watch);
    const Case given = read_case(options.case_file, options.settings);
    const Mesh mesh = written_mesh_of(given, options.out, watch);
    const QualitySummary quality = summarise_quality(mesh);
    fmt::print("{}: {} tets, {} vertices, worst R/r {:.2f}, dihedral angles {:.1f} to {:.1f} degrees\n",
               options.out.string(), quality.tets, quality.vertices, quality.max_aspect_ratio,
               quality.min_dihedral, quality.max_dihedral);
    fmt::print("{}", describe(body_sizes(given.domain, mesh)));
    return done;
}

/// A full disk behind a redirected output shows when what was printed is handed over.
void flush_output() {
    std::cout.flush();  // CLI11's
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout.good())
        throw FileError(fmt::format("the output cannot be written: {}", std::strerror(errno)));
}

/// Prints what was found. Throws FileError.
void hand_over(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    flush_output();
}

/// All about one file; of several, a line each and a summary.
int check_meshes(const std::vector<std::filesystem::path>& paths) {
    const auto files = files_to_check(paths);
    if (files == paths && files.size() == 1) {
        const CheckReport report = check_file(files.front());
        hand_over(report.text);
        return report.valid ? done : file_trouble;
    }
    std::size_t valid = 0;
    for (const auto& file : files) {
        const CheckLine line = check_line(file);
        if (line.valid) ++valid;
        hand_over(line.text);
    }
    hand_over(fmt::format("{} of {} files are valid\n", valid, files.size()));
    return valid == files.size() ? done : file_trouble;
}

int report_run(const std::filesystem::path& folder) {
    if (std::filesystem::exists(folder / sweep_table_name)) {
        write_sweep_report(folder);
        fmt::print("{}: written\n", (folder / sweep_page_name).string());
        return done;
    }
    Watch watch;
    const CatchInterrupts catching(watch);
    try {
        write_report(folder, {.watch = &watch});
    } catch (const Interrupted&) {
        throw Interrupted("interrupted; the report was not written");
    }
    fmt::print("{}: written\n", (folder / "report.html").string());
    return done;
}

int start_case(const std::string& name) {
    const std::filesystem::path path = write_new_case(name);
    fmt::print("{0}: written. Change it as you like, then: kropla run {0} --out {1}\n", path.string(),
               path.stem().string());
    return done;
}

/// What was asked for, as CLI11 fills it in.
struct Request {
    RunOptions run;
    MeshOptions mesh;
    MeshFiles convert, improve;
    SweepOptions sweep;
    std::filesystem::path file;  // or folder
    std::vector<std::filesystem::path> files;  // or folders
    std::string name;
};

void describe_settings(CLI::App& command, std::vector<std::string>& settings) {
    command
        .add_option("--set", settings,
                    "put a value in place of the case's: KEY is a parameter, or a full name such as size.surface, "
                    "body[0].radius, heat.region.droplet.conductivity; may be given several times")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
}

void describe_threads(CLI::App& command, int& threads) {
    command.add_option("--threads", threads, "threads to use (else one per processor); the results are the same")
        ->check(CLI::Range(1, 4096))
        ->type_name("N");
}

void describe_run(CLI::App& app, RunOptions& options) {
    CLI::App* run =
        app.add_subcommand("run", "Runs a case: frames, steps.csv and a checkpoint go into a folder");
    run->add_option("CASE", options.case_file, "the case file (TOML; see `kropla new`)")->required();
    run->add_option("--out", options.out, "the folder that the run fills")->required()->type_name("DIR");
    describe_settings(*run, options.settings);
    run->add_flag("--resume", options.resume, "go on from the checkpoint in the folder");
    run->add_flag("--force", options.force, "overwrite the run that the folder holds");
    run->add_flag("--test-rollback", options.test_rollback,
                  "refuse every step once after it was computed and redo it; the results are the same");
    run->add_option("--debug-mesh", options.debug_mesh,
                    "if the surface of a body is at fault, write the triangles that are to a VTU file")
        ->type_name("FILE");
    describe_threads(*run, options.threads);
    run->footer(
        "PETSc's options reach it untouched; put them last:\n"
        "  kropla run droplet.toml --out droplet -ksp_monitor -ksp_rtol 1e-10\n"
        "Another value for a key of the case: kropla run droplet.toml --out fine --set size.surface=1e-4\n"
        "Several processes share the solution: mpirun -n 2 kropla run droplet.toml --out droplet\n"
        "Look at the result: paraview droplet/frames.pvd\n"
        "Ctrl-C drops the step under way and leaves a checkpoint; --resume goes on from it, to the bit as if nothing\n"
        "had been, also with a later time.end or another output.every in the case. A second Ctrl-C ends at once.");
}

void describe_sweep(CLI::App& app, SweepOptions& options) {
    CLI::App* sweep = app.add_subcommand("sweep", "Runs a case for several values of parameters or keys, and compares");
    sweep->add_option("CASE", options.case_file, "the case file")->required();
    sweep
        ->add_option("--set", options.settings,
                     "values for a parameter or a key of the case, as in kropla run; of several --set with lists, all "
                     "combinations are run")
        ->required()
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE,VALUE,...");
    sweep->add_option("--out", options.out, "the folder of the sweep")->required()->type_name("DIR");
    describe_threads(*sweep, options.threads);
    sweep->footer(
        "Example: kropla sweep droplet.toml --set size.surface=2e-4,3e-4 --out sizes\n"
        "Each run has a folder in DIR, such as size.surface=2e-4; DIR/sweep.csv has a row and DIR/sweep.html the charts\n"
        "of all. Ctrl-C leaves a checkpoint of the run under way; the same command goes on: what is complete is not run\n"
        "again, what failed is tried again from its checkpoint. PETSc's options go to each run; put them last.\n"
        "Exit code: the largest of the runs' codes; 130 interrupted");
}

void describe_conversions(CLI::App& app, Request& request) {
    CLI::App* convert = app.add_subcommand("convert", "Writes a mesh in another format, its regions and patches kept");
    convert->add_option("IN", request.convert.in, "the mesh to read")->required();
    convert->add_option("OUT", request.convert.out, "the mesh to write")->required();
    convert->footer(
        "Formats go by the names: .vtu (VTK), .msh (Gmsh; 2.2 and 4.1 are read, 4.1 is written), .mesh (Medit):\n"
        "  kropla convert tank.msh tank.vtu");

    CLI::App* improve = app.add_subcommand("improve", "Makes the tets of a mesh better, its boundary and interfaces kept");
    improve->add_option("IN", request.improve.in, "the mesh to read")->required();
    improve->add_option("-o,--output", request.improve.out, "the mesh to write")->required()->type_name("OUT");
    improve->add_flag("--remesh-surface", request.improve.remesh_surface,
                      "also split, collapse, swap and slide the triangles where two regions meet, volumes kept");
    describe_threads(*improve, request.improve.threads);
    improve->footer(
        "Formats as of kropla convert:\n"
        "  kropla improve tank.msh -o better.msh\n"
        "  kropla improve tank.msh -o better.msh --remesh-surface\n"
        "Vertices on boundary and interfaces stay, and so do prisms; with --remesh-surface those on interfaces between\n"
        "two regions, away from the boundary, do not. A table tells how good the mesh was and is.");
}

void describe_others(CLI::App& app, Request& request) {
    CLI::App* mesh = app.add_subcommand("mesh", "Writes the initial mesh of a case, and nothing more");
    mesh->add_option("CASE", request.mesh.case_file, "the case file")->required();
    mesh->add_option("-o,--output", request.mesh.out, "the file to write: .vtu, .msh or .mesh")->required()->type_name("FILE");
    describe_settings(*mesh, request.mesh.settings);
    mesh->footer("Example: kropla mesh droplet.toml -o droplet.vtu");

    CLI::App* check = app.add_subcommand("check", "Tells whether meshes are valid, and how good they are");
    check->add_option("FILE", request.files, "mesh files (.vtu, .msh, .mesh), a PVD file, or the folder of a run")->required();
    check->footer(
        "Of one file all is told, of several a line each:\n"
        "  kropla check droplet/frames/00010.vtu\n"
        "  kropla check droplet\n"
        "Cells of surfaces, lines and points are passed over.\n"
        "Exit code: 0 all valid, 5 not, or not readable");

    CLI::App* report =
        app.add_subcommand("report", "Writes report.html, the run on one page, into its folder; of a sweep sweep.html");
    report->add_option("DIR", request.file, "the folder of a run or sweep, finished or not")->required();
    report->footer("Example: kropla report droplet");

    CLI::App* start = app.add_subcommand("new", "Writes a commented case to start from");
    start->add_option("NAME", request.name, "of the case: NAME.toml is written")->required();
    start->footer("Example: kropla new droplet");
}

void describe(CLI::App& app, Request& request) {
    app.require_subcommand(1);
    app.set_version_flag("--version", "kropla " KROPLA_VERSION);
    app.set_help_all_flag("--help-all", "Print the help of all commands");
    describe_run(app, request.run);
    describe_sweep(app, request.sweep);
    describe_others(app, request);
    describe_conversions(app, request);
    app.footer(
        "Example:\n"
        "  kropla new droplet\n"
        "  kropla run droplet.toml --out droplet\n"
        "  paraview droplet/frames.pvd\n"
        "Exit codes: 0 done, 2 bad arguments or case, 3 the mesh cannot keep its floors,\n"
        "4 the solver failed, 5 a file cannot be read or written, or a mesh is not valid, 6 not enough memory,\n"
        "70 internal error, 130 interrupted (of a run, the checkpoint is written).");
}

int dispatch(const CLI::App& app, const Request& request) {
    if (app.got_subcommand("run")) return run(request.run);
    if (app.got_subcommand("sweep")) return sweep(request.sweep);
    if (app.got_subcommand("mesh")) return write_initial_mesh(request.mesh);
    if (app.got_subcommand("convert")) return convert_mesh(request.convert);
    if (app.got_subcommand("improve")) return improve_mesh_file(request.improve);
    if (app.got_subcommand("check")) return check_meshes(request.files);
    if (app.got_subcommand("report")) return report_run(request.file);
    return start_case(request.name);
}

int complain(const std::string& what, int code) {
    std::string line = what;
    std::ranges::replace(line, '\n', ' ');
    fmt::print(stderr, "kropla: {}\n", line);
    return code;
}

/// The case of a run, sweep or mesh; of other commands the file or folder.
const std::filesystem::path& subject(const CLI::App& app, const Request& request) {
    if (app.got_subcommand("run")) return request.run.case_file;
    if (app.got_subcommand("sweep")) return request.sweep.case_file;
    return app.got_subcommand("mesh") ? request.mesh.case_file : request.file;
}

/// What memory was asked for, if that is a case.
std::string too_much(const CLI::App& app, const Request& request) {
    if (!app.got_subcommand("run") && !app.got_subcommand("mesh")) return "not enough memory";
    try {
        const auto& settings = app.got_subcommand("run") ? request.run.settings : request.mesh.settings;
        const Case given = read_case(subject(app, request), settings);
        return fmt::format("{}: not enough memory for about {:.1e} tets; larger size.surface and size.far take less",
                           subject(app, request).string(), estimate_tets(given.domain));
    } catch (const std::exception&) {
        return "not enough memory";
    }
}

/// Carries a request out. Bodies that do not fit are a fault of the case, which is named.
int carry_out(const CLI::App& app, const Request& request) {
    try {
        return dispatch(app, request);
    } catch (const CaseError& error) {
        return complain(error.what(), bad_case);
    } catch (const DomainError& error) {
        return complain(fmt::format("{}: {}", subject(app, request).string(), error.what()), bad_case);
    } catch (const Interrupted& error) {
        return complain(error.what(), interrupted);
    } catch (const FloorError& error) {
        return complain(error.what(), floors_unreachable);
    } catch (const SolverError& error) {
        return complain(error.what(), solver_failed);
    } catch (const FieldError& error) {
        return complain(error.what(), solver_failed);
    } catch (const FileError& error) {
        return complain(error.what(), file_trouble);
    } catch (const std::filesystem::filesystem_error& error) {
        return complain(fmt::format("{}: {}", error.path1().string(), error.code().message()), file_trouble);
    } catch (const std::bad_alloc&) {
        return complain(too_much(app, request), resources_used_up);
    } catch (const std::system_error& error) {  // no more threads, say
        return complain(fmt::format("the system refused: {}", error.what()), resources_used_up);
    }
}

/// Has all that was said arrived?
int end_with(int code) {
    try {
        flush_output();
        return code;
    } catch (const FileError& error) {
        return complain(error.what(), file_trouble);
    }
}

int execute_or_throw(const std::vector<std::string>& arguments) {
    Request request;
    CLI::App app("Kropla: finite-element simulation on a 3D mesh that follows moving boundaries", "kropla");
    describe(app, request);
    PartedArguments parted = part_arguments(arguments);
    try {
        check_words(app, parted.others);
        std::ranges::reverse(parted.others);  // CLI11 takes them from the back
        app.parse(parted.others);
    } catch (const CLI::Success& asked) {  // --help, --version
        return end_with(app.exit(asked));
    } catch (const CLI::ParseError& error) {
        return complain(what_is_wrong(app, error), bad_case);
    } catch (const CaseError& error) {
        return complain(error.what(), bad_case);
    }
    if (!parted.solver.empty() && !app.got_subcommand("run") && !app.got_subcommand("sweep")) {
        return complain(fmt::format("{} is an option of `kropla run`", parted.solver.front()), bad_case);
    }
    request.run.solver_options = request.sweep.solver_options = parted.solver;
    const int code = carry_out(app, request);
    return code == done ? end_with(code) : code;
}

}  // namespace

PartedArguments part_arguments(const std::vector<std::string>& arguments) {
    // Our own words have one letter or two dashes.
    const auto is_solvers = [](const std::string& word) {
        return word.size() > 2 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
    };
    const auto is_value = [](const std::string& word) {  // -1e-3 is a value, -ksp_monitor and --out are not
        return word.size() < 2 || word[0] != '-' || std::isdigit(static_cast<unsigned char>(word[1])) ||
               word[1] == '.';
    };
    PartedArguments parted;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (!is_solvers(arguments[i])) {
            parted.others.push_back(arguments[i]);
            continue;
        }
        parted.solver.push_back(arguments[i]);
        if (i + 1 < arguments.size() && is_value(arguments[i + 1])) parted.solver.push_back(arguments[++i]);
    }
    return parted;
}

int execute(std::vector<std::string> arguments) {
    try {
        return execute_or_throw(arguments);
    } catch (const std::exception& error) {
        return complain(fmt::format("internal error: {}; please report it, with the case file", error.what()),
                        internal_error);
    } catch (...) {
        return complain("internal error; please report it, with the case file", internal_error);
    }
}

}  // namespace kropla
