// SPDX-License-Identifier: MIT
#include "base/program.h"
#include "base/bytes.h"
#include "base/interrupt_install.h"
#include "base/json.h"
#include "base/outfile.h"

#include <errno.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Whether standard output is a pipe whose reader has closed it, as `head` does when it has enough.
static bool reader_left(void)
{
    struct pollfd output = {.fd = STDOUT_FILENO, .events = POLLOUT};
    return poll(&output, 1, 0) > 0 && (output.revents & POLLERR);
}

void program_begin(int argc, char *const *argv)
{
    bytes_set_command_line(argc, argv);
    interrupt_install();
    json_memory_watch();
}

int program_end(const char *name, Result result, Error *error)
{
    outfile_end();
    bool reported = result != RESULT_OK && error->text[0];
    errno = 0;
    bool lost = fflush(stdout) != 0 || ferror(stdout);
    // A stream remembers that a write failed, but not why; write once more to get the errno.
    if (lost && !errno && write(STDOUT_FILENO, "\n", 1) >= 0) errno = EIO;
    if (lost && !reported && !reader_left())
        result =
            error_set(error, RESULT_FAILED, "cannot write to standard output: %s", strerror(errno));
    if (result != RESULT_OK && error->text[0]) fprintf(stderr, "%s: %s\n", name, error->text);
    return result;
}
