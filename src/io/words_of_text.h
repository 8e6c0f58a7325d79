#pragma once

#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

namespace kropla {

/// Takes the next word off the front of the text, whatever blanks are before it; empty at the end.
inline std::string_view take_word(std::string_view& text) {
    const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    std::size_t begin = 0;
    while (begin < text.size() && is_blank(text[begin])) ++begin;
    std::size_t end = begin;
    while (end < text.size() && !is_blank(text[end])) ++end;
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

/// Takes the next line off the front, without its end.
inline std::string_view take_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

/// Is the whole word a finite number? Puts it into `number` then.
inline bool is_number(std::string_view word, double& number) {
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && stop == word.data() + word.size() && !word.empty() && std::isfinite(number);
}

}  // namespace kropla
