#pragma once

#include <toml++/toml.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kropla {

/// "key=value" of the command line, taken apart. Throws CaseError if it has no key or no value.
struct Setting {
    std::string key, value;
};
[[nodiscard]] Setting parted_setting(const std::string& text);

/// The values of a list, "100,150,200": parted at commas, but not at those within brackets, braces or quotes.
[[nodiscard]] std::vector<std::string> values_of_list(std::string_view text);

/// Puts each setting, "key=value", into the tables of a case file. The key is the name of a parameter, or a key's full
/// name as in `body[0].radius`, where a body may also be called by its name: `body.droplet.radius`. The value is TOML;
/// where the key holds a text, or nothing yet, what is not TOML is the text itself. What is put in has the setting as
/// its source, for CaseTable to refuse it by.
/// Throws CaseError, "--set KEY=VALUE: ...", if the value cannot be read, a key is set twice, is no key, or leads to
/// no place; keys that the place does not know are refused when it is read.
void apply_settings(std::span<const std::string> settings, toml::table& file);

}  // namespace kropla
