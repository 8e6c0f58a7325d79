// The layout of a VTU file, after the page "VTK XML formats" of VTK's documentation. An appended array in raw
// encoding begins, at its offset from the underscore, with words of header_type and byte_order:
//
//     uncompressed   bytes                 the length of the data that follow
//
//     compressed     blocks                how many there are
//                    block size            before compression
//                    last block's size     where it is a partial block, else 0
//                    size of each block    as it follows
//
// In base64, appended or between the tags of its element, the header of a compressed array is encoded by
// itself, padding included, and the blocks follow.

#include "io/vtu_text.h"

#include <kropla/base/error.h>
#include "io/xml.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace kropla {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
    throw FileError(path.string() + ": " + what);
}

/// What the elements read so far say.
struct Layout {
    std::string_view appended;  // all after the underscore
    std::size_t word = 4;       // [bytes] of a number in an array's header
    bool big_endian = false, compressed = false, raw = false;
    std::uint64_t points = 0, cells = 0;  // of the piece
    std::string_view section;             // FieldData, PointData, CellData, Points or Cells
    VtuText text;
    std::vector<std::pair<std::string_view, std::string>> changes;  // what stands in the text, and what is to
};

std::optional<std::uint64_t> number(std::string_view element, std::string_view name) {
    auto text = xml_attribute(element, name);
    if (!text) return {};
    while (text->ends_with(' ')) text->remove_suffix(1);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (error != std::errc() || end != text->data() + text->size()) return {};
    return value;
}

std::uint64_t read_word(std::string_view bytes, std::size_t at, const Layout& layout) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < layout.word; ++i) {
        const std::size_t from = layout.big_endian ? i : layout.word - 1 - i;
        value = value << 8 | static_cast<unsigned char>(bytes[at + from]);
    }
    return value;
}

/// The first `size` bytes of a base64 text, or as many as there are.
std::string decoded(std::string_view text, std::size_t size) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0, count = 0;
    for (const char c : text) {
        const std::size_t digit = digits.find(c);
        if (digit == std::string_view::npos || bytes.size() == size) break;
        bits = (bits << 6 | static_cast<unsigned>(digit)) & 0xffffff;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 0xff);
    }
    return bytes;
}

/// The header of a compressed array as bytes, and how many bytes are left for its blocks.
struct Header {
    std::string bytes;
    std::uint64_t room = 0;
};
/// Nothing if it is not there as a whole.
std::optional<Header> read_header(std::string_view array, bool base64, const Layout& layout) {
    const auto part = [&](std::size_t size) {
        return base64 ? decoded(array, size) : std::string(array.substr(0, size));
    };
    const std::string first = part(layout.word);
    if (first.size() < layout.word) return {};
    const std::uint64_t blocks = read_word(first, 0, layout);
    if (blocks > array.size() / layout.word) return {};
    const std::size_t size = (3 + blocks) * layout.word, length = base64 ? (size + 2) / 3 * 4 : size;
    if (length > array.size()) return {};
    Header header = {part(size), base64 ? (array.size() - length) / 4 * 3 : array.size() - length};
    return header.bytes.size() == size ? std::optional(header) : std::nullopt;
}

/// The size of a compressed array's data [bytes], or nothing if its header or its blocks do not fit in the
/// file.
std::optional<std::uint64_t> unpacked_size(std::string_view array, bool base64, const Layout& layout) {
    const auto header = read_header(array, base64, layout);
    if (!header) return {};
    const std::uint64_t blocks = read_word(header->bytes, 0, layout);
    const std::uint64_t block = read_word(header->bytes, layout.word, layout);
    const std::uint64_t last = read_word(header->bytes, 2 * layout.word, layout);
    std::uint64_t packed = 0;
    for (std::uint64_t i = 0; i < blocks; ++i) {
        const std::uint64_t size = read_word(header->bytes, (3 + i) * layout.word, layout);
        if (size > header->room - packed) return {};
        packed += size;
    }
    constexpr std::uint64_t largest_block = std::uint64_t{1} << 30;  // [bytes] far above any writer's choice
    constexpr std::uint64_t best_ratio = 20000;                      // [-] above that of VTK's compressors
    if (blocks == 0) return last == 0 ? std::optional(blocks) : std::nullopt;
    if (block == 0 || block > largest_block || last > block) return {};
    const std::uint64_t size = last == 0 ? blocks * block : (blocks - 1) * block + last;
    return size <= best_ratio * packed ? std::optional(size) : std::nullopt;
}

/// The size of the array's data [bytes], or nothing if it is not in the file as a whole.
std::optional<std::uint64_t> stored_size(std::string_view array, bool base64, const Layout& layout) {
    if (layout.compressed) return unpacked_size(array, base64, layout);
    const std::string header = base64 ? decoded(array, layout.word) : std::string(array.substr(0, layout.word));
    if (header.size() < layout.word) return {};
    const std::uint64_t size = read_word(header, 0, layout);
    if (base64) return size <= array.size() / 4 * 3 ? std::optional(size) : std::nullopt;
    return size <= array.size() - layout.word ? std::optional(size) : std::nullopt;
}

/// The size of a value by the type's name [bytes]; 0 for those of no fixed size.
std::uint64_t width_of(std::string_view type) {
    constexpr std::array<std::pair<std::string_view, std::uint64_t>, 10> widths = {
        {{"Int8", 1}, {"UInt8", 1}, {"Int16", 2}, {"UInt16", 2}, {"Int32", 4}, {"UInt32", 4}, {"Int64", 8},
         {"UInt64", 8}, {"Float32", 4}, {"Float64", 8}}};
    for (const auto& [name, width] : widths)
        if (type == name) return width;
    return 0;
}

template <class Number>
bool is_number(std::string_view word) {
    Number value;
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() && std::isfinite(static_cast<double>(value));
}

/// A number that this type can hold; texts are the numbers of their letters.
bool is_value(std::string_view word, std::string_view type) {
    if (type == "Int8") return is_number<std::int8_t>(word);
    if (type == "UInt8" || type == "String") return is_number<std::uint8_t>(word);
    if (type == "Int16") return is_number<std::int16_t>(word);
    if (type == "UInt16") return is_number<std::uint16_t>(word);
    if (type == "Int32") return is_number<std::int32_t>(word);
    if (type == "UInt32") return is_number<std::uint32_t>(word);
    if (type == "Int64") return is_number<std::int64_t>(word);
    if (type == "UInt64") return is_number<std::uint64_t>(word);
    return is_number<double>(word);
}

/// How many values of an array are in plain text. Throws FileError if one is none of the type.
std::uint64_t count_values(const std::filesystem::path& path, const std::string& name, std::string_view type,
                           std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    std::uint64_t count = 0;
    for (std::size_t at = text.find_first_not_of(blanks); at != std::string_view::npos; at = text.find_first_not_of(blanks, at)) {
        const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
        const std::string_view word = text.substr(at, end - at);
        if (!is_value(word, type))
            fail(path, "is damaged: the array " + name + " holds \"" + std::string(word.substr(0, 40)) +
                           "\", which is not a finite number of the type " + std::string(type));
        ++count;
        at = end;
    }
    return count;
}

/// How many values each component of this array has; nothing: it is not said.
std::optional<std::uint64_t> promised_values(std::string_view element, std::string_view name, const Layout& layout) {
    if (layout.section == "FieldData") return number(element, "NumberOfTuples");
    if (layout.section == "PointData" || layout.section == "Points") return layout.points;
    if (layout.section == "CellData") return layout.cells;
    if (layout.section == "Cells" && (name == "offsets" || name == "types")) return layout.cells;
    return {};
}

/// An array of texts of the whole file, of so many bytes: is to be read as bytes.
void take_as_bytes(std::string_view element, std::uint64_t bytes, Layout& layout) {
    layout.changes.emplace_back(*xml_attribute(element, "type"), "UInt8");
    if (const auto count = xml_attribute(element, "NumberOfTuples")) layout.changes.emplace_back(*count, std::to_string(bytes));
    if (const auto count = xml_attribute(element, "NumberOfComponents")) layout.changes.emplace_back(*count, "1");
}

void change(std::string& bytes, std::vector<std::pair<std::string_view, std::string>> changes) {
    std::vector<std::size_t> at;
    std::ranges::sort(changes, std::ranges::greater(), [](const auto& c) { return c.first.data(); });
    for (const auto& [old, value] : changes) at.push_back(static_cast<std::size_t>(old.data() - bytes.data()));
    for (std::size_t i = 0; i < at.size(); ++i) bytes.replace(at[i], changes[i].first.size(), changes[i].second);
}

/// `content` is what follows the element.
void check_array(const std::filesystem::path& path, std::string_view element, std::string_view content,
                 Layout& layout) {
    const std::string name(xml_attribute(element, "Name").value_or(""));
    const std::string_view type = xml_attribute(element, "type").value_or("");
    if (width_of(type) == 0 && type != "String" && type != "Bit")
        fail(path, "the array " + name + " has the type \"" + std::string(type) + "\", which is none of VTK's for files");
    if (type == "String" && layout.section == "PointData") return layout.text.of_points.push_back(unescaped(name));
    if (type == "String" && layout.section == "CellData") return layout.text.of_cells.push_back(unescaped(name));
    const auto components = xml_attribute(element, "NumberOfComponents") ? number(element, "NumberOfComponents") : 1;
    if (!components) fail(path, "is damaged: the array " + name + " does not say how many components it has");
    const bool appended = xml_attribute(element, "format") == "appended";
    if (appended) {
        const auto offset = number(element, "offset");
        if (!offset || *offset > layout.appended.size())
            fail(path, "is damaged: the array " + name + " is not in the file");
        content = layout.appended.substr(*offset);
    } else if (xml_attribute(element, "format") == "binary") {
        content = content.substr(0, content.find('<'));
        content.remove_prefix(std::min(content.find_first_not_of(" \t\r\n"), content.size()));
    } else {
        content = content.substr(0, content.find('<'));
        const std::uint64_t count = count_values(path, name, type, content);
        if (type == "String") return take_as_bytes(element, count, layout);
        const std::uint64_t values = promised_values(element, name, layout).value_or(0);
        if (values > 0 && *components > count / values)
            fail(path, "is damaged: the array " + name + " has fewer values than are promised");
        return;
    }
    const auto size = stored_size(content, !appended || !layout.raw, layout);
    if (!size) fail(path, "is damaged: the sizes of the array " + name + " are impossible");
    if (type == "String") return take_as_bytes(element, *size, layout);
    const std::uint64_t values = promised_values(element, name, layout).value_or(0);
    const std::uint64_t width = width_of(type);
    if (values > 0 && width > 0 && *components > *size / width / values)
        fail(path, "is damaged: the array " + name + " has fewer values than are promised");
}

void look_at(const std::filesystem::path& path, std::string_view text, std::size_t file_size,
             Layout& layout) {
    const std::string_view element = text.substr(0, text.find('>'));
    const std::string_view name = element.substr(0, element.find_first_of(" \t\r\n/>"));
    if (name == "VTKFile") {
        layout.word = xml_attribute(element, "header_type") == "UInt64" ? 8 : 4;
        layout.big_endian = xml_attribute(element, "byte_order") == "BigEndian";
        layout.compressed = !xml_attribute(element, "compressor").value_or("").empty();
    } else if (name == "Piece") {
        const auto points = number(element, "NumberOfPoints"), cells = number(element, "NumberOfCells");
        if (!points || !cells) fail(path, "is damaged: it does not say how many vertices and cells it has");
        if (*points > file_size || *cells > file_size)  // neither takes less than a byte
            fail(path, "is damaged: it promises more vertices or cells than it can hold");
        layout.points = *points;
        layout.cells = *cells;
        layout.text.cells += *cells;
    } else if (name == "FieldData" || name == "PointData" || name == "CellData" || name == "Points" || name == "Cells") {
        layout.section = name;
    } else if (name == "DataArray" || name == "Array") {
        check_array(path, element, text.substr(std::min(element.size() + 1, text.size())), layout);
    }
}

}  // namespace

VtuText check_vtu_text(const std::filesystem::path& path, std::string& whole) {
    const std::string_view bytes = whole;
    if (bytes.empty()) fail(path, "is empty");
    const std::size_t start = bytes.substr(0, 4096).find("<VTKFile");
    if (start == std::string_view::npos) fail(path, "is not a VTU file");
    const std::string_view first = bytes.substr(start, bytes.find('>', start) - start);
    if (xml_attribute(first, "type") != "UnstructuredGrid")
        fail(path, "is a VTK file, but not of an unstructured grid (VTU)");
    constexpr std::size_t tail = 64;  // [bytes] room for blanks at the end
    if (bytes.substr(bytes.size() - std::min(bytes.size(), tail)).find("</VTKFile>") ==
        std::string_view::npos)
        fail(path, "is truncated: it does not end with </VTKFile>");

    const std::size_t data = std::min(bytes.find("<AppendedData"), bytes.size());
    const std::string_view text = bytes.substr(0, data);
    Layout layout;
    if (data < bytes.size()) {
        const std::size_t end = std::min(bytes.find('>', data), bytes.size()),
                          underscore = bytes.find('_', end);
        layout.raw = xml_attribute(bytes.substr(data, end - data), "encoding") == "raw";
        if (underscore != std::string_view::npos) layout.appended = bytes.substr(underscore + 1);
    }
    for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1))
        look_at(path, text.substr(at + 1), bytes.size(), layout);
    change(whole, std::move(layout.changes));
    return std::move(layout.text);
}

}  // namespace kropla
