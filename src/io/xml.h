#pragma once

#include <optional>
#include <string_view>

namespace kropla {

/// The value of an attribute as it stands in the text of an XML element, `<name key="value" ...`, escapes not
/// undone; nothing if it has none of that name.
[[nodiscard]] std::optional<std::string_view> xml_attribute(std::string_view element, std::string_view name);

}  // namespace kropla
