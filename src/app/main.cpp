#include "app/commands.h"

#include <csignal>

int main(int count, char** arguments) {
    std::signal(SIGXFSZ, SIG_IGN);  // a file that may grow no further is an error of writing as others are
    return kropla::execute({arguments + 1, arguments + count});
}
