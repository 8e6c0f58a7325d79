#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace kropla {

/// Takes words and numbers out of the bytes of a file, one after another, numbers as text or as the bytes of memory.
/// Whatever is not as it is asked for is a FileError that names file and line, or byte, and what was expected.
class Scanner {
public:
    /// `bytes` outlive this object.
    Scanner(std::filesystem::path path, std::string_view bytes) : path_(std::move(path)), bytes_(bytes) {}

    /// Whether nothing but blanks, and lines of comment, are left.
    [[nodiscard]] bool at_end();
    /// Up to the next blank; empty at the end.
    std::string_view word();
    /// The word that comes next, which is not taken.
    [[nodiscard]] std::string_view next_word();
    /// What is left of the line, without its end.
    std::string_view line();
    /// Takes all up to and with `text`; whether it is there.
    bool skip_past(std::string_view text);
    /// Throws unless a count of things of so many bytes each, or more, can be in what is left.
    std::size_t count(std::string_view what, std::size_t least_bytes);

    /// From now on numbers are bytes, in the order of this machine or reversed; or text again.
    void read_bytes(bool reversed) { binary_ = true, reversed_ = reversed; }
    void read_text() { binary_ = false; }
    [[nodiscard]] bool is_binary() const { return binary_; }
    /// A comment begins with this and ends with its line; '\0': there are none. Calls `f` for each that is passed.
    void comments(char begin) { comment_ = begin; }
    /// All comments passed so far, a line each.
    [[nodiscard]] const std::string& passed_comments() const { return comments_; }

    /// A number, finite, within its type's range.
    template <class T>
    T number(std::string_view what) {
        T value{};
        if (binary_) take_bytes(&value, sizeof value, what);
        else take_text(value, what);
        if constexpr (std::is_floating_point_v<T>)
            if (!std::isfinite(value)) fail(std::string(what) + " is not a finite number");
        return value;
    }

    [[noreturn]] void fail(const std::string& what) const;

private:
    void skip_blanks();
    void take_bytes(void* value, std::size_t size, std::string_view what);
    [[noreturn]] void fail_number(std::string_view what, std::string_view word) const;
    template <class T>
    void take_text(T& value, std::string_view what) {
        std::string_view text = word();
        if (text.starts_with('+')) text.remove_prefix(1);
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if constexpr (std::is_floating_point_v<T>)
            if (error == std::errc::result_out_of_range && end == text.data() + text.size()) {
                value = tiny_or_huge(text);  // 1e-320 is 0, near enough; 1e400 is refused
                return;
            }
        if (error != std::errc() || end != text.data() + text.size()) fail_number(what, text);
    }
    [[nodiscard]] static double tiny_or_huge(std::string_view text);

    std::filesystem::path path_;
    std::string_view bytes_;
    std::size_t at_ = 0, last_ = 0;  // where the next begins; the last thing taken
    bool binary_ = false, reversed_ = false;
    char comment_ = '\0';
    std::string comments_;
};

/// The shortest text that reads as the same number.
void append_number(std::string& text, double value);
void append_number(std::string& text, std::size_t value);

}  // namespace kropla
