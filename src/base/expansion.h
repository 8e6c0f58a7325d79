#pragma once

#include <cmath>

// Exact arithmetic on floating-point expansions, after [Shewchuk 1997] and [Dekker 1971]: a number is the
// unevaluated sum of doubles, nonzero, nonoverlapping and rising in size, so that the last has the sign of
// all. Exact as long as nothing under- or overflows and the compiler neither fuses nor reorders
// (-ffp-contract=off). The capacity, the largest number of terms that an operation can leave, is part of the
// type, so that nothing is allocated.

namespace kropla {

template <int Capacity>
struct Expansion {
    double term[Capacity];  // only the first `size` are set
    int size = 0;

    void append(double t) {
        if (t != 0) term[size++] = t;
    }
};

template <int N>
[[nodiscard]] int sign(const Expansion<N>& e) {
    if (e.size == 0) return 0;
    return e.term[e.size - 1] > 0 ? 1 : -1;
}

/// high + low, exactly: high the rounded result, low its error.
struct TwoTerms {
    double high, low;
};

inline TwoTerms two_sum(double a, double b) {
    const double s = a + b;
    const double b_seen = s - a;
    return {s, (a - (s - b_seen)) + (b - b_seen)};
}

/// As two_sum, for |a| >= |b|.
inline TwoTerms fast_two_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
}

/// The upper 26 and the lower 26 bits of the mantissa (Dekker's splitting).
inline TwoTerms split(double a) {
    const double c = 0x8000001p0 * a;  // 2^27 + 1
    const double high = c - (c - a);
    return {high, a - high};
}

/// a * b exactly, b already split. Splitting rather than std::fma, which is a call where the target has no
/// such instruction.
inline TwoTerms two_product(double a, double b, TwoTerms b_split) {
    const double p = a * b;
    const TwoTerms s = split(a);
    const double rest = ((p - s.high * b_split.high) - s.low * b_split.high) - s.high * b_split.low;
    return {p, s.low * b_split.low - rest};
}

inline Expansion<2> exact_difference(double a, double b) {
    const TwoTerms d = two_sum(a, -b);
    Expansion<2> result;
    result.append(d.low);
    result.append(d.high);
    return result;
}

/// e + f for any expansions: merges the terms by size, then carries upwards (fast expansion sum).
template <int Result>
void add_into(Expansion<Result>& result, const double* e, int e_size, const double* f, int f_size) {
    result.size = 0;
    int i = 0, j = 0;
    const auto smallest = [&] {
        return j == f_size || (i < e_size && std::abs(e[i]) < std::abs(f[j])) ? e[i++] : f[j++];
    };
    if (e_size + f_size == 0) return;
    double carry = smallest();
    while (i < e_size || j < f_size) {
        const TwoTerms s = two_sum(carry, smallest());
        result.append(s.low);
        carry = s.high;
    }
    result.append(carry);
}

/// e * b (scale expansion).
template <int Result>
void scale_into(Expansion<Result>& result, const double* e, int e_size, double b) {
    result.size = 0;
    if (e_size == 0) return;
    const TwoTerms b_split = split(b);
    TwoTerms carry = two_product(e[0], b, b_split);
    result.append(carry.low);
    for (int i = 1; i < e_size; ++i) {
        const TwoTerms p = two_product(e[i], b, b_split);
        const TwoTerms s = two_sum(carry.high, p.low);
        result.append(s.low);
        carry = fast_two_sum(p.high, s.high);
        result.append(carry.low);
    }
    result.append(carry.high);
}

template <int M, int N>
[[nodiscard]] Expansion<M + N> operator+(const Expansion<M>& e, const Expansion<N>& f) {
    Expansion<M + N> result;
    add_into(result, e.term, e.size, f.term, f.size);
    return result;
}

template <int N>
[[nodiscard]] Expansion<N> operator-(const Expansion<N>& e) {
    Expansion<N> result;
    for (int i = 0; i < e.size; ++i) result.append(-e.term[i]);
    return result;
}

template <int M, int N>
[[nodiscard]] Expansion<M + N> operator-(const Expansion<M>& e, const Expansion<N>& f) {
    return e + -f;
}

/// The sum of e scaled by each term of f.
template <int M, int N>
[[nodiscard]] Expansion<2 * M * N> operator*(const Expansion<M>& e, const Expansion<N>& f) {
    Expansion<2 * M * N> sum, next;
    Expansion<2 * M> scaled;
    Expansion<2 * M * N>* from = &sum;
    Expansion<2 * M * N>* to = &next;
    for (int i = 0; i < f.size; ++i) {
        scale_into(scaled, e.term, e.size, f.term[i]);
        add_into(*to, from->term, from->size, scaled.term, scaled.size);
        Expansion<2 * M * N>* filled = to;
        to = from;
        from = filled;
    }
    if (from != &sum) {
        sum.size = 0;
        for (int i = 0; i < next.size; ++i) sum.append(next.term[i]);
    }
    return sum;
}

}  // namespace kropla
