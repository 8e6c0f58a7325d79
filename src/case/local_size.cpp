#include "case/local_size.h"

#include <kropla/base/error.h>
#include <kropla/domain/words.h>

#include <fmt/format.h>
#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace kropla {
namespace {

/// Asked by many threads: each has an expression of its own.
class SizeExpression {
public:
    /// `refusal` is how an error begins.
    SizeExpression(const Expression& size, std::string refusal)
        : sizes_([size] { return size; }), refusal_(std::move(refusal)) {}

    [[nodiscard]] double operator()(const Vec3& x) {
        const double size = sizes_.local()(0, x);
        if (size >= least_length && size <= most_length) return size;
        throw CaseError(fmt::format("{}must be a positive length everywhere, but is {:.6g} m at {}", refusal_, size, place_words(x)));
    }

private:
    tbb::enumerable_thread_specific<Expression> sizes_;
    std::string refusal_;
};

}  // namespace

bool is_of_place(const CaseTable& table, std::string_view key) {
    if (!table.holds_text(key)) return false;
    return std::ranges::any_of(names_in(table.text(key)), [](const std::string& name) {
        return name == "x" || name == "y" || name == "z";
    });
}

std::vector<Vec3> places_on(const Shape& shape) {
    constexpr int across = 12;
    const Bounds box = bounds(shape);
    std::vector<Vec3> places;
    for (int i = 0; i < across; ++i)
        for (int j = 0; j < across; ++j)
            for (int k = 0; k < across; ++k) {
                const Vec3 part = Vec3{i + 0.5, j + 0.5, k + 0.5} / across, span = box.max - box.min;
                const Vec3 x = box.min + Vec3{part.x * span.x, part.y * span.y, part.z * span.z};
                places.push_back(closest_point(shape, x));
            }
    return places;
}

PlacedSize read_placed_size(const CaseTable& table, std::string_view key, std::span<const Shape> shapes) {
    if (shapes.empty()) table.refuse_value(key, "must be a length: there is no body without one of its own, at whose places it could be asked for");
    const auto sizes = std::make_shared<SizeExpression>(table.expression(key, Variables::place), table.refusal(key, ""));
    PlacedSize read{[sizes](const Vec3& x) { return (*sizes)(x); }, 0};
    for (const Shape& shape : shapes)
        for (const Vec3& x : places_on(shape)) read.most = std::max(read.most, read.size(x));
    return read;
}

}  // namespace kropla
