#include "experiments/commands/cli.h"

int main(int argc, char** argv) { return qtrace::experiments::run_command_line(argc, argv); }
