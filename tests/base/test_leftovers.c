// SPDX-License-Identifier: MIT
// Files that killed and interrupted runs left behind are removed, and no other files are.
#include "base/bytes.h"
#include "base/interrupt_install.h"
#include "base/leftovers.h"
#include "base/outfile.h"
#include "support/temporary.h"

#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

// Starts a process that writes half a file and then calls `end`. Returns the process's exit state.
static int half_write(const char *path, void (*end)(void))
{
    pid_t child = fork();
    if (child == 0) {
        OutFile file;
        interrupt_install();
        if (outfile_open(&file, path, NULL) != RESULT_OK) _exit(99);
        fprintf(file.stream, "half");
        fflush(file.stream);
        end();
        _exit(98);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

static void be_killed(void)
{
    raise(SIGKILL);
}

// Stands for work that never looks at the interrupt flag.
static void be_deaf(void)
{
    raise(SIGTERM); // SIGHUP may be ignored, as by nohup
    for (;;) pause();
}

static void the_next_run_removes_what_a_killed_one_left(void **state)
{
    char path[300];
    Error error;
    snprintf(path, sizeof path, "%s", temporary_path(state, "x"));
    assert_true(WIFSIGNALED(half_write(path, be_killed)));
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
    Bytes bytes = {.data = (uint8_t *)"whole", .size = 5};
    assert_int_equal(bytes_write_file(&bytes, path, &error), RESULT_OK);
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
    assert_true(temporary_has(state, "x"));
}

static void a_program_that_does_not_notice_a_signal_ends_and_leaves_nothing(void **state)
{
    int status = half_write(temporary_path(state, "x"), be_deaf);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), RESULT_INTERRUPTED);
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 0);
}

static void sweep(void **state)
{
    int root = open("/", O_PATH), folder = open(temporary_path(state, "."), O_PATH);
    leftovers_sweep(root); // the folder of an earlier test may have had the same inode
    leftovers_sweep(folder);
    close(root);
    close(folder);
}

// Files of living processes, files of other machines, locked files, and files of any other name.
static void files_that_may_be_in_use_are_kept(void **state)
{
    char dead[LEFTOVER_NAME_SIZE], name[4][LEFTOVER_NAME_SIZE];
    pid_t child = fork();
    if (child == 0) _exit(0);
    assert_int_equal(waitpid(child, NULL, 0), child);
    leftovers_name(dead, 0);
    unsigned host, number;
    long process;
    assert_int_equal(sscanf(dead, ".tractrix-%08x-%ld-%u.tmp", &host, &process, &number), 3);
    snprintf(name[0], sizeof *name, ".tractrix-%08x-%ld-0.tmp", host, (long)getppid());
    snprintf(name[1], sizeof *name, ".tractrix-%08x-%ld-0.tmp", host + 1, (long)child);
    snprintf(name[2], sizeof *name, ".tractrix-%08x-%ld-1.tmp", host, (long)child); // locked
    snprintf(name[3], sizeof *name, ".tractrix-%08x-%ld-x.tmp", host, (long)child);
    for (int i = 0; i < 4; ++i) temporary_write(state, name[i], "mine", 0644);
    snprintf(dead, sizeof dead, ".tractrix-%08x-%ld-2.tmp", host, (long)child);
    temporary_write(state, dead, "old", 0644);
    int locked = open(temporary_path(state, name[2]), O_RDONLY);
    assert_int_equal(flock(locked, LOCK_SH), 0);
    sweep(state);
    assert_false(temporary_has(state, dead));
    for (int i = 0; i < 4; ++i) assert_true(temporary_has(state, name[i]));
    close(locked);
}

// A process that has ended stays in the list of processes until its parent asks for its status.
static void what_a_zombie_left_is_removed(void **state)
{
    char name[LEFTOVER_NAME_SIZE];
    unsigned host, number;
    long process;
    pid_t child = fork();
    siginfo_t info;
    if (child == 0) _exit(0);
    assert_int_equal(waitid(P_PID, (id_t)child, &info, WEXITED | WNOWAIT), 0);
    leftovers_name(name, 0);
    assert_int_equal(sscanf(name, ".tractrix-%08x-%ld-%u.tmp", &host, &process, &number), 3);
    snprintf(name, sizeof name, ".tractrix-%08x-%ld-0.tmp", host, (long)child);
    temporary_write(state, name, "old", 0644);
    sweep(state);
    assert_false(temporary_has(state, name));
    assert_int_equal(waitpid(child, NULL, 0), child);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(the_next_run_removes_what_a_killed_one_left),
        TEST(a_program_that_does_not_notice_a_signal_ends_and_leaves_nothing),
        TEST(files_that_may_be_in_use_are_kept),
        TEST(what_a_zombie_left_is_removed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
