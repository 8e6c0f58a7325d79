#include "io/scanner.h"

#include <kropla/base/error.h>

#include <algorithm>
#include <cstdlib>

namespace kropla {
namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

void Scanner::skip_blanks() {
    for (;;) {
        while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
        if (comment_ == '\0' || at_ == bytes_.size() || bytes_[at_] != comment_) return;
        comments_ += line();
        comments_ += '\n';
    }
}

bool Scanner::at_end() {
    skip_blanks();
    return at_ == bytes_.size();
}

std::string_view Scanner::word() {
    skip_blanks();
    last_ = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_])) ++at_;
    return bytes_.substr(last_, at_ - last_);
}

std::string_view Scanner::next_word() {
    const std::size_t at = at_;
    const std::string_view next = word();
    at_ = at;
    return next;
}

std::string_view Scanner::line() {
    const std::size_t begin = at_, end = std::min(bytes_.find('\n', at_), bytes_.size());
    at_ = std::min(end + 1, bytes_.size());
    std::string_view line = bytes_.substr(begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

bool Scanner::skip_past(std::string_view text) {
    const std::size_t found = bytes_.find(text, at_);
    if (found == std::string_view::npos) return false;
    at_ = found + text.size();
    return true;
}

std::size_t Scanner::count(std::string_view what, std::size_t least_bytes) {
    const auto value = number<std::size_t>("the number of " + std::string(what));
    if (value <= (bytes_.size() - at_) / least_bytes && value <= std::numeric_limits<std::int32_t>::max()) return value;
    fail("promises " + std::to_string(value) + " " + std::string(what) + ", more than the file can hold");
}

void Scanner::take_bytes(void* value, std::size_t size, std::string_view what) {
    last_ = at_;
    if (bytes_.size() - at_ < size) fail("ends where " + std::string(what) + " should be");
    std::array<char, 8> bytes{};
    std::memcpy(bytes.data(), bytes_.data() + at_, size);
    if (reversed_) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    std::memcpy(value, bytes.data(), size);
    at_ += size;
}

double Scanner::tiny_or_huge(std::string_view text) { return std::strtod(std::string(text).c_str(), nullptr); }

void Scanner::fail_number(std::string_view what, std::string_view word) const {
    if (word.empty()) fail("ends where " + std::string(what) + " should be");
    constexpr std::size_t most = 40;  // of what may be anything
    fail(std::string(what) + " is no number of its kind: \"" + std::string(word.substr(0, most)) + "\"");
}

void Scanner::fail(const std::string& what) const {
    const auto lines = std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(last_), '\n');
    const std::string place = binary_ ? "byte " + std::to_string(last_) : "line " + std::to_string(lines + 1);
    throw FileError(path_.string() + ": " + place + ": " + what);
}

void append_number(std::string& text, double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    text.append(buffer.data(), end);
}

void append_number(std::string& text, std::size_t value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    text.append(buffer.data(), end);
}

}  // namespace kropla
