// SPDX-License-Identifier: MIT
#include "compare/ci_path.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The absolute path without links and dots. If the file does not exist, only its folder is
// resolved; NULL if the folder does not exist, either. Owned by the caller.
static char *resolve(const char *path)
{
    char *whole = realpath(path, NULL), *name = NULL;
    if (whole) return whole;
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    whole = folder ? realpath(folder, NULL) : NULL;
    if (whole && asprintf(&name, "%s/%s", whole, slash ? slash + 1 : path) < 0) name = NULL;
    free(folder);
    free(whole);
    return name;
}

static char *find_root(void)
{
    const char *root = getenv("CI_PROJECT_DIR");
    if (!root) root = getenv("GITHUB_WORKSPACE");
    return realpath(root && *root ? root : ".", NULL);
}

char *ci_path(const char *path)
{
    char *whole = resolve(path), *root = find_root();
    size_t length = root ? strlen(root) : 0;
    const char *best = whole ? whole : path;
    if (whole && root && !getenv("JENKINS_URL") && strncmp(whole, root, length) == 0 &&
        whole[length] == '/')
        best = whole + length + 1;
    char *name = strdup(best);
    free(whole);
    free(root);
    return name;
}
