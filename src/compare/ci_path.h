// SPDX-License-Identifier: MIT
// File names in the form that CI servers expect.
#pragma once

// The name of the file relative to the checkout's folder: $CI_PROJECT_DIR (GitLab),
// $GITHUB_WORKSPACE, or else the working directory. Absolute if the file lies outside, or if
// $JENKINS_URL is set, as Jenkins' plugin for attachments requires. The file need not exist. To be
// freed; NULL when memory is short.
char *ci_path(const char *path);
