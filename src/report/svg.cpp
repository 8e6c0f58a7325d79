#include "report/svg.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace kropla {
namespace {

std::string to_text(double value, std::chars_format format, int precision) {
    std::array<char, 64> text;
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value, format, precision);
    return {text.data(), result.ptr};
}

/// The colour at 0 ... 1 of an even row of colours, linear between them.
std::string between(std::span<const std::uint32_t> colours, double fraction) {
    const double place = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(colours.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), colours.size() - 2);
    const double rest = place - static_cast<double>(below);
    std::string text = "#";
    for (const int shift : {16, 8, 0}) {
        const double a = (colours[below] >> shift) & 255, b = (colours[below + 1] >> shift) & 255;
        const auto level = static_cast<unsigned>(std::lround(a + rest * (b - a)));
        text += "0123456789abcdef"[level / 16];
        text += "0123456789abcdef"[level % 16];
    }
    return text;
}

}  // namespace

std::string pixels(double value) {
    const long tenths = std::lround(value * 10);
    std::string text = (tenths < 0 ? "-" : "") + std::to_string(std::labs(tenths) / 10);
    if (tenths % 10 != 0) text += '.' + std::to_string(std::labs(tenths) % 10);
    return text;
}

std::string readable(double value, int digits) {
    const double size = std::abs(value);
    // The short form of to_chars turns to powers of ten when there are more digits than asked for: not for
    // counts.
    if (size >= std::pow(10, digits) && size < 1e7) return to_text(value, std::chars_format::fixed, 0);
    return to_text(value, std::chars_format::general, digits);
}

std::string readable_count(double value) {
    std::string text = to_text(value, std::chars_format::fixed, 0);
    for (std::ptrdiff_t i = std::ssize(text) - 3; i > (value < 0 ? 1 : 0); i -= 3) {
        text.insert(static_cast<std::size_t>(i), "\u202f");
    }
    return text;
}

std::string readable_time(double seconds) {
    const double size = std::abs(seconds);
    if (size >= 120) {
        const double minutes = std::floor(seconds / 60);
        return readable_count(minutes) + " min " + readable(std::floor(seconds - 60 * minutes), 2) + " s";
    }
    if (size >= 1 || size == 0) return readable(seconds, 3) + " s";
    if (size >= 1e-3) return readable(seconds * 1e3, 3) + " ms";
    return readable(seconds * 1e6, 3) + " µs";
}

std::string polygon_path(std::span<const Point2> corners) {
    std::string path = "M";
    for (const Point2& p : corners) {
        if (path.size() > 1) path += ' ';
        path += pixels(p.x) + ',' + pixels(p.y);
    }
    return path + 'z';
}

std::string line_path(std::span<const Point2> points) {
    std::string path;
    bool drawing = false;
    for (const Point2& p : points) {
        const bool finite = std::isfinite(p.x) && std::isfinite(p.y);
        if (finite) path += (drawing ? 'L' : 'M') + pixels(p.x) + ',' + pixels(p.y);
        drawing = finite;
    }
    return path;
}

std::vector<double> round_ticks(double least, double most, int count) {
    const double rough = (most - least) / std::max(1, count - 1);
    const double ten = std::pow(10.0, std::floor(std::log10(rough)));
    double step = 10 * ten;
    for (const double factor : {5.0, 2.0, 1.0}) {
        if (factor * ten >= rough) step = factor * ten;
    }
    std::vector<double> ticks;
    const double first = std::ceil(least / step - 1e-9), last = std::floor(most / step + 1e-9);
    for (int i = 0; i < count && first + i <= last; ++i) ticks.push_back((first + i) * step + 0.0);  // + 0: no minus zero
    return ticks;
}

int digits_for(std::span<const double> ticks) {
    constexpr int least = 5, most = 8;
    if (ticks.size() < 2) return least;
    const double largest = std::max(std::abs(ticks.front()), std::abs(ticks.back()));
    return std::clamp(1 + static_cast<int>(std::ceil(std::log10(largest / (ticks[1] - ticks[0])))), least, most);
}

bool is_flat(double least, double most) {
    constexpr double share = 1e-6;
    return most - least <= share * std::max(std::abs(most), std::abs(least));
}

std::string inferno(double fraction) {
    constexpr std::array<std::uint32_t, 10> colours = {0x000004, 0x1b0c41, 0x4a0c6b, 0x781c6d, 0xa52c60,
                                                       0xcf4446, 0xed6925, 0xfb9b06, 0xf7d13d, 0xfcffa4};
    return between(colours, fraction);
}

std::string light_blues(double fraction) {
    constexpr std::array<std::uint32_t, 7> colours = {0xffffd9, 0xedf8b1, 0xc7e9b4, 0x7fcdbb,
                                                      0x41b6c4, 0x1d91c0, 0x225ea8};
    return between(colours, fraction);
}

std::string blue_to_red(double fraction) {
    constexpr std::array<std::uint32_t, 9> colours = {0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7,
                                                      0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b};
    return between(colours, fraction);
}

}  // namespace kropla
