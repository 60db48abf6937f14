// SPDX-License-Identifier: MIT
#include "bench/waited.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>

static void add_thread(Waited *sum, const char *number)
{
    char path[300];
    double ran, waited; // ns
    snprintf(path, sizeof path, "/proc/self/task/%s/schedstat", number);
    FILE *file = fopen(path, "r");
    if (!file) return; // the thread has ended meanwhile
    if (fscanf(file, "%lf %lf", &ran, &waited) == 2)
        sum->ran += 1e-6 * ran, sum->waited += 1e-6 * waited;
    fclose(file);
}

Waited waited_now(void)
{
    Waited sum = {0, 0};
    DIR *threads = opendir("/proc/self/task");
    if (!threads) return sum;
    for (const struct dirent *entry; (entry = readdir(threads));)
        if (entry->d_name[0] != '.') add_thread(&sum, entry->d_name);
    closedir(threads);
    return sum;
}

double waited_since(Waited before)
{
    Waited now = waited_now();
    double ran = fmax(now.ran - before.ran, 0), waited = fmax(now.waited - before.waited, 0);
    return ran + waited > 0 ? waited / (ran + waited) : 0;
}
