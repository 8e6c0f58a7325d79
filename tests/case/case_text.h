#pragma once

#include "case/case.h"
#include <kropla/base/error.h>

#include <string>
#include <string_view>

namespace kropla {

/// A case with every key, all different from the defaults, to be spoiled one line at a time.
inline constexpr std::string_view full_case = R"toml([domain]
min = [-0.004, -0.004, 0.0]
max = [ 0.004,  0.004, 0.016]
[[body]]
name = "droplet"
shape = "sphere"
centre = [0.0, 0.0, 0.013]
radius = 0.001
[body.motion]
x = "0.0003*sin(4*pi*t/0.01)"
y = 0
z = "-1.0*t"
[[body]]
name = "egg \"2\""
shape = "ellipsoid"
centre = [0.0, 0.0, 0.003]
axes = [1e-3, 0.8e-3, 0.7e-3]
rotation = [0, 1, 1, 30.0]
[size]
surface = 3e-4
growth = 0.15
far = 7e-4
[quality]
max_aspect_ratio = 9.5
[time]
end = 0.01
steps = 40
[heat.region.surroundings]
conductivity = 0.02
density = 1.6
specific_heat = 520
initial = 300
[heat.region.droplet]
conductivity = 35
density = 7000
specific_heat = 800
initial = 2400.5
source = "1e6*x*t + y - z"
[heat.region."egg \"2\""]
conductivity = 35
density = 7000
specific_heat = 800
initial = 300.1
[heat.face]
x_min = { value = 300 }
y_max = { flux = "1e4*sin(t)" }
z_min = "insulated"
[output]
every = 5
[random]
seed = 9223372036854775807
)toml";

/// The text with its first `from` turned into `to`.
inline std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
    std::string changed(text);
    return changed.replace(changed.find(from), from.size(), to);  // throws if it is not there
}

/// What is said of a text; empty if it is a right case.
inline std::string refusal(const std::string& text) {
    try {
        (void)parse_case(text, "case.toml");
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

}  // namespace kropla
