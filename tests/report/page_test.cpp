#include <kropla/base/error.h>
#include "io/file.h"
#include <kropla/io/vtk.h>
#include "report/page.h"
#include "report/run_files.h"
#include "tiny_run.h"

#include <gtest/gtest.h>

#include <regex>

namespace kropla {
namespace {

/// The first tag of a page that does not fit, if any: every element is closed in order.
std::string unclosed_tag(const std::string& html) {
    static const std::regex tag("<(/?)([a-z0-9]+)((?:\"[^\"]*\"|[^\">])*?)(/?)>");
    std::vector<std::string> open;
    for (std::sregex_iterator it(html.begin(), html.end(), tag), end; it != end; ++it) {
        const std::string name = (*it)[2];
        if ((*it)[1] == "/") {
            if (open.empty() || open.back() != name) return "</" + name + ">";
            open.pop_back();
        } else if ((*it)[4] != "/") {
            open.push_back(name);
        }
    }
    return open.empty() ? "" : open.back();
}

std::string page_of(const TinyRun& run) {
    const auto dir = test_folder("page");
    write_tiny_run(dir, run);
    write_report(dir);
    std::string html = read_file(dir / "report.html");
    std::filesystem::remove_all(dir);
    return html;
}

void expect_sound(const std::string& html) {
    EXPECT_EQ(unclosed_tag(html), "");
    EXPECT_EQ(html.find("http"), std::string::npos);  // nothing from elsewhere
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_LT(html.size(), 5'000'000U);
    EXPECT_NE(html.find("a &lt; b &amp; c"), std::string::npos);  // the case, escaped
}

int count_of(const std::string& html, const std::string& what) {
    int count = 0;
    for (auto at = html.find(what); at != std::string::npos; at = html.find(what, at + 1)) ++count;
    return count;
}

TEST(Page, ShowsAFinishedRun) {
    const std::string html = page_of({});
    expect_sound(html);
    EXPECT_NE(html.find("Finished at 500 ms"), std::string::npos);
    EXPECT_NE(html.find("Temperature [K], cut"), std::string::npos);
    EXPECT_LT(html.find("<h2>Results</h2>"), html.find("<h2>Mesh</h2>"));  // also where steps.csv tells nothing of them
    EXPECT_LT(html.find("verdict good"), html.find("<h2>Results</h2>"));
    const std::regex cells("class=\"picture cells\"");
    EXPECT_EQ(std::distance(std::sregex_iterator(html.begin(), html.end(), cells), {}), 6);
}

TEST(Page, ShowsTheSizesOfBodies) {
    const std::string html = page_of({});
    EXPECT_NE(html.find("Sizes of the bodies"), std::string::npos);
    EXPECT_NE(html.find("<tr><td>1</td><td>1, 2, 1.25 m</td><td>10.47 m³</td><td>off by 1e-08 of it</td>"
                        "<td>48</td><td>1.14 m</td></tr>"),
              std::string::npos);
    const std::string older = page_of({.bodies = false});
    expect_sound(older);
    EXPECT_EQ(older.find("Sizes of the bodies"), std::string::npos);
}

TEST(Page, ShowsARunWithoutHeat) {
    const std::string html = page_of({.heat = false});
    expect_sound(html);
    EXPECT_EQ(html.find("Temperature"), std::string::npos);
}

TEST(Page, ShowsAFlowFromWhereItFlows) {
    const std::string html = page_of({.heat = false, .flow = true});
    expect_sound(html);
    for (const char* part : {"<h3>Speed [m/s], cut</h3>", "<h3>Speed [m/s], around the first body</h3>",
                             "<h3>Pressure [Pa], cut</h3>"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
    EXPECT_EQ(count_of(html, "class=\"picture field\""), 6);  // at the start nothing flows
    EXPECT_EQ(count_of(html, "class=\"solid\""), 6);
    EXPECT_EQ(count_of(html, "class=\"shaft\""), 4);
    const std::string warm = page_of({.flow = true});
    EXPECT_NE(warm.find("Temperature [K], cut"), std::string::npos);
    EXPECT_NE(warm.find("Speed [m/s], cut"), std::string::npos);
}

TEST(Page, ShowsAnInterruptedRun) {
    for (const int rows : {0, 1, 3}) {
        const std::string html = page_of({.rows = rows});
        expect_sound(html);
        EXPECT_NE(html.find("verdict unfinished"), std::string::npos) << rows;
    }
}

/// A run that ended early, at a place of its mesh.
void end_tiny_run(const std::filesystem::path& dir) {
    write_vtu(dir / ending_mesh_name, grid_of_cubes({3, 3, 3}, [](int i, int j, int k) {
                  return i == 1 && j == 1 && k == 1 ? Region(1) : surroundings;
              }));
    write_file(dir / ending_name,
               "# Why the run ended early.\nwhy = \"at t = 1 ms body \\\"a\\\" is 2e-05 m from the wall z min\"\n"
               "place = [1.5, 1.4, 0.5]  # m\n");
}

TEST(Page, BeginsWithWhyARunEndedAndShowsWhere) {
    const auto dir = test_folder("ended");
    write_tiny_run(dir, {.rows = 3});
    end_tiny_run(dir);
    write_report(dir);
    const std::string html = read_file(dir / "report.html");
    std::filesystem::remove_all(dir);
    expect_sound(html);
    EXPECT_NE(html.find("verdict bad\">Ended early at 300 ms of 500 ms: at t = 1 ms body &quot;a&quot; is 2e-05 m from the "
                        "wall z min</p>"), std::string::npos) << html.substr(html.find("verdict bad"), 200);
    EXPECT_NE(html.find("cut at (1.5, 1.4, 0.5) m"), std::string::npos);
    EXPECT_EQ(count_of(html, "<circle class=\"mark\""), 2);
    EXPECT_NE(html.find("Over time"), std::string::npos);
}

TEST(Page, ShowsARunThatEndedBeforeItsFirstStep) {
    const auto dir = test_folder("never");
    std::filesystem::create_directories(dir);
    end_tiny_run(dir);
    write_report(dir);
    const std::string html = read_file(dir / "report.html");
    EXPECT_EQ(unclosed_tag(html), "");
    EXPECT_NE(html.find("Ended early: at t = 1 ms body"), std::string::npos);
    EXPECT_EQ(count_of(html, "<circle class=\"mark\""), 2);
    write_file(dir / ending_name, "place = [1, 2]\n");
    EXPECT_THROW(write_report(dir), FileError);
    std::filesystem::remove_all(dir);
}

TEST(Page, NamesTheFileThatIsMissingOrBroken) {
    const auto dir = test_folder("broken");
    for (const char* file :
         {"case.toml", "steps.csv", "frames.pvd", "frames/00000.vtu", "frames/00005.vtu"}) {
        for (const bool there : {false, true}) {
            write_tiny_run(dir);
            if (there) write_file(dir / file, "");
            else std::filesystem::remove(dir / file);
            if (there && std::string(file) == "case.toml") continue;  // a case that says nothing is no fault
            try {
                write_report(dir);
                ADD_FAILURE() << file << " was not missed";
            } catch (const FileError& error) {
                EXPECT_NE(std::string(error.what()).find((dir / file).string()), std::string::npos)
                    << error.what();
            }
            EXPECT_FALSE(std::filesystem::exists(dir / "report.html"));
        }
    }
    std::filesystem::remove_all(dir);
    EXPECT_THROW(write_report(dir), FileError);
}

TEST(Page, IsNotWrittenIfTheWatchSaysStop) {
    const auto dir = test_folder("stopped");
    write_tiny_run(dir);
    write_file(dir / "report.html", "the one before");
    Watch watch;
    watch.stop = true;
    EXPECT_THROW(write_report(dir, {.watch = &watch}), Interrupted);
    EXPECT_EQ(read_file(dir / "report.html"), "the one before");
    std::filesystem::remove_all(dir);
}

}  // namespace
}  // namespace kropla
