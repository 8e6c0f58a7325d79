#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kropla {

/// The value of an attribute as it stands in the text of an XML element, `<name key="value" ...`, escapes not
/// undone; nothing if it has none of that name.
[[nodiscard]] std::optional<std::string_view> xml_attribute(std::string_view element, std::string_view name);

/// Text as it stands in XML and HTML, also between quotes; and back.
[[nodiscard]] std::string escaped(std::string_view text);
[[nodiscard]] std::string unescaped(std::string_view text);

}  // namespace kropla
