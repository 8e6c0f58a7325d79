// ParaView's collections: an XML file of a few lines, of which we write all and read the elements DataSet.

#include <kropla/io/pvd.h>

#include <kropla/base/error.h>
#include "io/file.h"
#include "io/xml.h"

#include <array>
#include <charconv>
#include <optional>

namespace kropla {
namespace {

/// The shortest text that reads back as the same number.
std::string shortest(double value) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::optional<SeriesEntry> parse_entry(std::string_view element) {
    const auto time = xml_attribute(element, "timestep");
    const auto file = xml_attribute(element, "file");
    if (!time || !file) return {};
    SeriesEntry entry{0, unescaped(*file)};
    const char* end = time->data() + time->size();
    const auto [stopped, error] = std::from_chars(time->data(), end, entry.time);
    if (error != std::errc() || stopped != end) return {};
    return entry;
}

}  // namespace

void write_pvd(const std::filesystem::path& path, std::span<const SeriesEntry> entries) {
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "  <Collection>\n";
    for (const SeriesEntry& entry : entries)
        text += "    <DataSet timestep=\"" + shortest(entry.time) + "\" part=\"0\" file=\"" +
                escaped(entry.file) + "\"/>\n";
    text += "  </Collection>\n</VTKFile>\n";
    write_file(path, text);
}

std::vector<SeriesEntry> read_pvd(const std::filesystem::path& path) {
    const std::string text = read_file(path);
    if (text.find("type=\"Collection\"") == std::string::npos)
        throw FileError(path.string() + ": is not a PVD file");
    if (text.find("</VTKFile>") == std::string::npos)
        throw FileError(path.string() + ": is truncated: it does not end with </VTKFile>");
    std::vector<SeriesEntry> entries;
    for (std::size_t at = text.find("<DataSet"); at != std::string::npos;
         at = text.find("<DataSet", at + 1)) {
        const std::string_view rest = std::string_view(text).substr(at);
        const auto entry = parse_entry(rest.substr(0, rest.find("/>")));
        if (!entry)
            throw FileError(path.string() + ": is damaged: frame " + std::to_string(entries.size()) +
                            " has no time or no file");
        entries.push_back(*entry);
    }
    return entries;
}

}  // namespace kropla
