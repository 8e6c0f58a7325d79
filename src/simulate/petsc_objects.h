#pragma once

#include "simulate/linear_system.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace kropla {

// Vectors, matrices and null spaces of PETSc, for systems of the rows that ranks own.

/// Of so many owned entries.
[[nodiscard]] inline OwnedVec make_vector(const Ranks& ranks, std::size_t size) {
    Vec vector = nullptr;
    check(VecCreateMPI(ranks.communicator, static_cast<PetscInt>(size), PETSC_DETERMINE, &vector));
    return OwnedVec(vector);
}

/// Into the entries that this rank owns.
inline void put(const std::vector<double>& values, Vec vector) {
    double* place = nullptr;
    check(VecGetArrayWrite(vector, &place));
    std::copy(values.begin(), values.end(), place);
    check(VecRestoreArrayWrite(vector, &place));
}

/// The entries of all ranks, on every rank.
class Gathering {
public:
    Gathering(const Ranks& ranks, Vec vector) {
        if (ranks.count == 1) return;  // they are all there
        VecScatter scatter = nullptr;
        Vec everywhere = nullptr;
        check(VecScatterCreateToAll(vector, &scatter, &everywhere));
        scatter_.reset(scatter);
        everywhere_.reset(everywhere);
    }
    std::vector<double> operator()(Vec vector) const {
        if (!scatter_) return copy_of(vector);
        check(VecScatterBegin(scatter_.get(), vector, everywhere_.get(), INSERT_VALUES, SCATTER_FORWARD));
        check(VecScatterEnd(scatter_.get(), vector, everywhere_.get(), INSERT_VALUES, SCATTER_FORWARD));
        return copy_of(everywhere_.get());
    }

private:
    static std::vector<double> copy_of(Vec vector) {
        PetscInt size = 0;
        check(VecGetSize(vector, &size));
        const double* values = nullptr;
        check(VecGetArrayRead(vector, &values));
        std::vector<double> copy(values, values + size);
        check(VecRestoreArrayRead(vector, &values));
        return copy;
    }

    OwnedScatter scatter_;
    OwnedVec everywhere_;
};

/// PETSc's matrix of a pattern, with the values of one system after the other.
class Matrix {
public:
    Matrix(const Ranks& ranks, const SparseRows& rows, PetscInt all_rows) : rows_(rows), value_(rows.column.size(), 0.0) {
        const auto count = static_cast<PetscInt>(rows.count());
        auto *begin = const_cast<PetscInt*>(rows.begin.data()), *column = const_cast<PetscInt*>(rows.column.data());
        Mat matrix = nullptr;
        if (ranks.count == 1) {  // of the arrays as they are, which PETSc does not change
            check(MatCreateSeqAIJWithArrays(ranks.communicator, count, count, begin, column, value_.data(), &matrix));
        } else {
            check(MatCreateMPIAIJWithArrays(ranks.communicator, count, count, all_rows, all_rows, begin, column,
                                            value_.data(), &matrix));
            copies_ = true;
        }
        matrix_.reset(matrix);
    }

    /// Its rows, each divided by its scale.
    void take(const LinearSystem& system, const std::vector<double>& scale) {
        for (std::size_t r = 0; r < scale.size(); ++r) {
            double diagonal = system.row_sum[r];
            std::size_t own = 0;
            for (PetscInt k = rows_.begin[r]; k < rows_.begin[r + 1]; ++k) {
                const auto place = static_cast<std::size_t>(k);
                if (rows_.column[place] == rows_.first_row + static_cast<PetscInt>(r)) {
                    own = place;
                } else {
                    diagonal -= system.value[place];
                    value_[place] = system.value[place] / scale[r];
                }
            }
            value_[own] = diagonal / scale[r];
        }
        if (copies_) {
            check(MatUpdateMPIAIJWithArray(matrix_.get(), value_.data()));
        } else {
            double* changed = value_.data();
            check(MatSeqAIJRestoreArray(matrix_.get(), &changed));  // which tells PETSc so
        }
    }

    [[nodiscard]] Mat get() const { return matrix_.get(); }

private:
    const SparseRows& rows_;
    std::vector<double> value_;
    bool copies_ = false;
    OwnedMat matrix_;  // refers to the values: is destroyed before them
};

/// The constants of some pieces, which a matrix takes to next to nothing, as PETSc's null space.
class Constants {
public:
    Constants(const Ranks& ranks, const SparseRows& rows, std::vector<char> of_piece)
        : ranks_(ranks), rows_(rows), of_piece_(std::move(of_piece)),
          size_(sums_of_pieces(ranks, rows, [](std::size_t) { return 1; })) {
        MatNullSpace space = nullptr;
        check(MatNullSpaceCreate(ranks.communicator, PETSC_FALSE, 0, nullptr, &space));
        space_.reset(space);
        check(MatNullSpaceSetFunction(space, take_out, this));
    }
    Constants(const Constants&) = delete;
    Constants& operator=(const Constants&) = delete;

    [[nodiscard]] MatNullSpace get() const { return space_.get(); }

private:
    static PetscErrorCode take_out(MatNullSpace, Vec vector, void* context) {
        const auto& constants = *static_cast<const Constants*>(context);
        double* entry = nullptr;
        if (const PetscErrorCode code = VecGetArray(vector, &entry); code != 0) return code;
        constants.take_out(entry);
        return VecRestoreArray(vector, &entry);
    }
    void take_out(double* entry) const {
        std::vector<double> mean = sums_of_pieces(ranks_, rows_, [&](std::size_t r) { return entry[r]; });
        for (std::size_t p = 0; p < mean.size(); ++p) mean[p] = of_piece_[p] != 0 ? mean[p] / size_[p] : 0;
        for (std::size_t r = 0; r < rows_.count(); ++r) entry[r] -= mean[rows_.piece_of_owned(r)];
    }

    const Ranks& ranks_;
    const SparseRows& rows_;
    std::vector<char> of_piece_;
    std::vector<double> size_;  // unknowns of each piece
    OwnedNullSpace space_;
};

}  // namespace kropla
