#include "report/html.h"

#include "io/xml.h"
#include "report/style.h"

namespace kropla {

std::string html_page(const std::string& title, const std::string& content) {
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/><title>" +
           escaped(title) + " – Kropla</title><style>" + std::string(page_style) + "</style></head>\n<body><main>" +
           content + "</main></body></html>\n";
}

std::string tile(const std::string& name, const std::string& value) {
    return "<div class=\"tile\"><b>" + escaped(value) + "</b><span class=\"soft\">" + escaped(name) + "</span></div>";
}

std::string table_row(const char* cell, const std::vector<std::string>& values) {
    std::string html = "<tr>";
    for (const std::string& value : values) html += std::string("<") + cell + ">" + value + "</" + cell + ">";
    return html + "</tr>";
}

}  // namespace kropla
