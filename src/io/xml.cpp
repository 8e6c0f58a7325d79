#include "io/xml.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kropla {
namespace {

constexpr std::string_view blanks = " \t\r\n";
constexpr std::array<std::pair<char, std::string_view>, 4> escapes = {
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}}};

}  // namespace

std::optional<std::string_view> xml_attribute(std::string_view element, std::string_view name) {
    for (std::size_t at = element.find(name); at != std::string_view::npos; at = element.find(name, at + 1)) {
        if (at == 0 || blanks.find(element[at - 1]) == std::string_view::npos) continue;
        std::string_view rest = element.substr(at + name.size());
        rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
        if (!rest.starts_with('=')) continue;
        rest.remove_prefix(1);
        rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
        if (rest.empty() || (rest[0] != '"' && rest[0] != '\'')) continue;
        const std::size_t end = rest.find(rest[0], 1);
        if (end == std::string_view::npos) continue;
        return rest.substr(1, end - 1);
    }
    return {};
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        std::string_view written(&c, 1);
        for (const auto& [special, name] : escapes)
            if (c == special) written = name;
        result += written;
    }
    return result;
}

std::string unescaped(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        std::size_t used = 1;
        char c = text[0];
        for (const auto& [special, name] : escapes)
            if (text.starts_with(name)) c = special, used = name.size();
        result += c;
        text.remove_prefix(used);
    }
    return result;
}

}  // namespace kropla
