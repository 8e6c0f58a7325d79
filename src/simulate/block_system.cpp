#include "simulate/block_system.h"

#include <tbb/global_control.h>

namespace kropla {
namespace {

constexpr std::size_t least_rows =
    2048;  // of a part: a cube of some 13 vertices a side, every fourth cell is asked
           //   for twice
constexpr std::size_t parts_of_thread = 4;   // so that none has to wait long; a single thread has one part

std::size_t count_parts(std::size_t rows) {
    const std::size_t threads =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return threads == 1 ? 1 : std::clamp<std::size_t>(rows / least_rows, 1, parts_of_thread * threads);
}

template <std::size_t n>
std::vector<std::uint32_t> cells_of(const CellsAtRows<n>& at, std::size_t first_row, std::size_t end_row) {
    std::vector<std::uint32_t> cells;
    for (std::size_t k = at.begin[first_row]; k < at.begin[end_row]; ++k) cells.push_back(at.cells[k].cell);
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

}  // namespace

BlockPattern make_block_pattern(const Mesh& mesh, const Cells& cells, const Ranks& ranks, UpperSides upper) {
    BlockPattern blocks{make_pattern(mesh, cells, ranks, std::move(upper)), {}};
    const std::size_t rows = blocks.pattern.rows.count();
    const std::size_t count = count_parts(rows);
    blocks.parts.resize(count);
    for_all(count, [&](std::size_t p) {
        const std::size_t first = p * rows / count, end = (p + 1) * rows / count;
        blocks.parts[p] = {first, end, cells_of(blocks.pattern.tets, first, end),
                           cells_of(blocks.pattern.prisms, first, end),
                           cells_of(blocks.pattern.upper_tets, first, end),
                           cells_of(blocks.pattern.upper_prisms, first, end)};
    }, 1);
    return blocks;
}

}  // namespace kropla
