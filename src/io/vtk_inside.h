#pragma once

#include <kropla/base/error.h>
#include <kropla/base/watch.h>

#include <array>
#include <filesystem>
#include <string>
#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>

namespace kropla {

// What reading and writing by VTK have in common.

[[noreturn]] inline void fail(const std::filesystem::path& path, const std::string& what) {
    throw FileError(path.string() + ": " + what);
}

/// While it lives, VTK's messages are not shown; the first error is kept.
class CaughtErrors {
public:
    CaughtErrors() : before_(vtkOutputWindow::GetInstance()) {
        keep_first_->SetClientData(&first_);
        keep_first_->SetCallback([](vtkObject*, unsigned long, void* first, void* text) {
            auto& kept = *static_cast<std::string*>(first);
            if (kept.empty()) kept = static_cast<const char*>(text);
        });
        window_->AddObserver(vtkCommand::ErrorEvent, keep_first_);
        vtkOutputWindow::SetInstance(window_);
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    }
    ~CaughtErrors() {
        vtkOutputWindow::SetInstance(before_);
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_INFO);  // VTK's default; it cannot be asked
    }
    CaughtErrors(const CaughtErrors&) = delete;
    CaughtErrors& operator=(const CaughtErrors&) = delete;

    /// The first error in one line, without the place in VTK's code that found it; empty: none.
    [[nodiscard]] std::string first() const {
        const std::size_t who = first_.find("): ");
        std::string text = who == std::string::npos ? first_ : first_.substr(who + 3);
        return text.substr(0, text.find('\n'));
    }

private:
    vtkSmartPointer<vtkOutputWindow> before_;
    vtkNew<vtkStringOutputWindow> window_;
    vtkNew<vtkCallbackCommand> keep_first_;
    std::string first_;
};

/// VTK's wedge has its first triangle turned outwards, ours inwards: which of our corners each of VTK's is, and
/// the other way round. See the page of vtkWedge in VTK's documentation.
inline constexpr std::array<std::size_t, 6> wedge_corners = {0, 2, 1, 3, 5, 4};

/// Has one of VTK's algorithms ask the watch as often as it tells how far it is. It ends, not done, if the watch says
/// stop; the watch is to outlive it.
inline void let_stop(vtkAlgorithm* algorithm, const Watch* watch) {
    if (watch == nullptr) return;
    vtkNew<vtkCallbackCommand> ask;
    ask->SetClientData(const_cast<Watch*>(watch));
    ask->SetCallback([](vtkObject* working, unsigned long, void* asked, void*) {
        if (static_cast<const Watch*>(asked)->stop) static_cast<vtkAlgorithm*>(working)->SetAbortExecute(1);
    });
    algorithm->AddObserver(vtkCommand::ProgressEvent, ask);
}

/// The cell array that tells which patch a cell of a surface is of, and the arrays of texts, "3 rotor", of the whole
/// file that name regions and patches.
inline constexpr const char* patch_array = "patch";
inline constexpr const char* region_names_array = "region_names";
inline constexpr const char* patch_names_array = "patch_names";

}  // namespace kropla
