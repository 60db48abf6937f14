// SPDX-License-Identifier: MIT
// The first signal sets a flag, a second one ends the program, and a program that does not look at
// the flag is ended.
#include "base/error.h"
#include "base/interrupt.h"
#include "base/interrupt_install.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static const int SIGNALS[] = {SIGINT, SIGTERM, SIGHUP};
enum { SIGNAL_COUNT = 3, SEEN = 42, NOT_SEEN = 43 };

// Runs `child` with a signal in a process of its own, whose standard error is closed. Returns the
// status of waitpid.
static int run(void (*child)(int), int number)
{
    int status = 0;
    pid_t pid = fork();
    assert_true(pid >= 0);
    if (pid == 0) {
        for (int i = 0; i < SIGNAL_COUNT; ++i) signal(SIGNALS[i], SIG_DFL);
        close(STDERR_FILENO);
        child(number);
        _exit(SEEN);
    }
    assert_int_equal(waitpid(pid, &status, 0), pid);
    return status;
}

static void looks_at_the_flag(int number)
{
    interrupt_install();
    if (interrupt_requested()) _exit(NOT_SEEN);
    raise(number);
    if (!interrupt_requested()) _exit(NOT_SEEN);
}

static void gets_a_second_signal(int number)
{
    interrupt_install();
    raise(number);
    if (interrupt_requested()) raise(number);
}

static void looks_away(int number)
{
    interrupt_install();
    raise(number);
    for (;;) pause();
}

static void ignores_the_hangup(int number)
{
    signal(number, SIG_IGN); // as nohup does
    interrupt_install();
    raise(number);
    if (interrupt_requested()) _exit(NOT_SEEN);
}

static void signals_set_the_flag_once(void **state)
{
    (void)state;
    for (int i = 0; i < SIGNAL_COUNT; ++i) {
        int status = run(looks_at_the_flag, SIGNALS[i]);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), SEEN);
        status = run(gets_a_second_signal, SIGNALS[i]);
        assert_true(WIFSIGNALED(status));
        assert_int_equal(WTERMSIG(status), SIGNALS[i]);
        status = run(looks_away, SIGNALS[i]);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), RESULT_INTERRUPTED);
    }
}

static void a_hangup_that_is_ignored_stays_ignored(void **state)
{
    (void)state;
    int status = run(ignores_the_hangup, SIGHUP);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), SEEN);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signals_set_the_flag_once),
        cmocka_unit_test(a_hangup_that_is_ignored_stays_ignored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
