#pragma once

#include <cstdint>

namespace kropla {

/// The finalizer of SplitMix64: spreads each bit of `z` over all.
constexpr std::uint64_t mixed_bits(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

/// The n-th random number of the stream `seed`: the same on every machine and in any order of asking.
/// SplitMix64 as a counter-based generator, after [Steele, Lea, Flood 2014]; the seed is mixed first, so that
/// the streams of neighbouring seeds are not the same one shifted.
constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t n) {
    return mixed_bits(mixed_bits(seed + 0x632BE59BD9B4E019ULL) + n * 0x9E3779B97F4A7C15ULL);
}

/// A stream of random numbers: a seed and how many were drawn.
struct Random {
    std::uint64_t seed = 1;
    std::uint64_t drawn = 0;

    std::uint64_t bits() { return random_bits(seed, drawn++); }
    /// Uniform in [0, 1).
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
    /// Uniform in [a, b).
    double uniform(double a, double b) { return a + (b - a) * uniform(); }
    /// Uniform in 0 ... n-1, for n far below 2^64.
    std::uint64_t below(std::uint64_t n) { return bits() % n; }
};

}  // namespace kropla
