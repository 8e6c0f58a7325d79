#include "io/file.h"

#include <kropla/base/error.h>
#include "examples.h"

#include <csignal>
#include <sys/resource.h>

namespace kropla {
namespace {

std::size_t files_in(const Folder& folder) {
    const std::filesystem::directory_iterator files(folder.path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

TEST(File, IsReplacedAsAWhole) {
    const Folder folder;
    write_file(folder / "a", "first");
    write_file(folder / "a", std::string("sec\0nd", 6));
    EXPECT_EQ(read_file(folder / "a"), std::string("sec\0nd", 6));
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(File, IsAsItWasIfTheWatchSaysStop) {
    const Folder folder;
    write_file(folder / "a", "first");
    Watch watch;
    write_file(folder / "b", "first", &watch);
    watch.stop = true;
    EXPECT_THROW(write_file(folder / "a", "second", &watch), Interrupted);
    EXPECT_EQ(read_file(folder / "a"), "first");
    EXPECT_EQ(files_in(folder), 2u);
}

/// A disk that is full, played by a limit on the size of files.
TEST(File, SurvivesAFullDisk) {
    const Folder folder;
    write_file(folder / "a", "first");
    rlimit before = {};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small = {4096, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const auto message = message_of<FileError>([&] { write_file(folder / "a", std::string(10000, 'x')); });
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find("/a: cannot be written: File too large"), std::string::npos) << message;
    EXPECT_EQ(read_file(folder / "a"), "first");
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(File, IsNotWrittenOverAFolderOrADevice) {
    const Folder folder;
    EXPECT_NE(message_of<FileError>([&] { write_file(folder.path(), "x"); }).find("Is a directory"),
              std::string::npos);
    EXPECT_NE(message_of<FileError>([&] { write_file("/dev/null", "x"); }).find("not a regular file"),
              std::string::npos);
    EXPECT_NE(message_of<FileError>([&] { (void)read_file("/dev/null"); }).find("not a regular file"),
              std::string::npos);
}

}  // namespace
}  // namespace kropla
