#pragma once

#include <stdexcept>

namespace kropla {

/// The case is wrong: a key, a value, or two that do not fit. The message names file, key and value.
struct CaseError : std::runtime_error { using runtime_error::runtime_error; };

/// The domain asked for cannot be meshed or moved: bodies that overlap, a path that leaves the box.
struct DomainError : std::runtime_error { using runtime_error::runtime_error; };

/// A file that cannot be read or written. The message names it.
struct FileError : std::runtime_error { using runtime_error::runtime_error; };

/// The solver did not converge, or the library below it failed.
struct SolverError : std::runtime_error { using runtime_error::runtime_error; };

/// A field or weight to be carried is not finite. The message names vertex or cell, and value.
struct FieldError : std::runtime_error { using runtime_error::runtime_error; };

/// A field cannot be carried to another mesh with its integral. The message names region and place.
struct TransferError : std::runtime_error { using runtime_error::runtime_error; };

/// The mesh cannot keep its floors, whatever was tried. The message names the cell, the place and the time.
struct FloorError : std::runtime_error { using runtime_error::runtime_error; };

/// Whoever follows the computation has asked it to end (base/watch.h). What was under way is dropped.
struct Interrupted : std::runtime_error { using runtime_error::runtime_error; };

}  // namespace kropla
