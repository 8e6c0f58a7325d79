// docs/output.md has each column that a run writes, and no other.
#include "app/body_sizes.h"
#include "app/step_row.h"
#include "temporary_folder.h"
#include <kropla/domain/solids.h>

#include <gtest/gtest.h>

#include <sstream>

namespace kropla {
namespace {

/// The cells between backticks that begin rows of the tables of columns within a part of the page, with commas between.
std::string documented(const std::string& heading) {
    const std::string page = contents(std::filesystem::path(KROPLA_DOCS) / "output.md");
    const std::size_t begin = page.find("\n## " + heading + "\n");
    if (begin == std::string::npos) return "no such heading";
    std::istringstream part(page.substr(begin + 1, page.find("\n## ", begin + 1) - begin));
    std::string columns;
    for (std::string line; std::getline(part, line);)
        if (line.starts_with("| `")) columns += (columns.empty() ? "" : ",") + line.substr(3, line.find('`', 3) - 3);
    return columns;
}

TEST(OutputDocuments, HaveTheColumnsOfSteps) {
    Case given;
    given.domain.bodies.resize(1);
    given.domain.bodies[0].name = "NAME";
    given.domain.box = {{0, 0, 0}, {1, 1, 1}};
    given.domain.bodies[0].shape = slab(given.domain.box, {0, 0, 0}, {1, 1, 0.5});
    given.liquid = {1};
    given.heat.emplace();
    given.species = {{.name = "SPECIES", .regions = {}}};
    given.free.resize(1);
    given.free[0].emplace();
    given.contact.emplace();
    given.flow.emplace().options.regions.emplace_back(FlowRegion{});
    std::string header = csv_header(step_row(1, {}, {}, {}, given));
    for (const char* face : {"x_max", "y_min", "y_max", "z_min", "z_max"}) {
        for (const std::string& column : {std::string("heat_out_") + face + " [W],",
                                          std::string("volume_out_") + face + " [m^3/s],"}) {
            ASSERT_NE(header.find(column), std::string::npos) << column;
            header.erase(header.find(column), column.size());
        }
    }
    for (int kind = 0; kind < 2; ++kind) header.replace(header.find("x_min"), 5, "FACE");
    EXPECT_EQ(documented("steps.csv"), header);
}

TEST(OutputDocuments, HaveTheColumnsOfBodies) {
    const TemporaryFolder folder;
    write_bodies(folder.path / "bodies.csv", {}, {}, true);
    EXPECT_EQ(documented("bodies.csv") + "\n", contents(folder.path / "bodies.csv"));
}

}  // namespace
}  // namespace kropla
