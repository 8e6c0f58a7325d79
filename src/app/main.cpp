#include "app/commands.h"

int main(int count, char** arguments) { return kropla::execute({arguments + 1, arguments + count}); }
