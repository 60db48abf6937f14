// SPDX-License-Identifier: MIT
// File names as servers of continuous integration want them.
#pragma once

// The name of the file relative to the folder of the checkout: that of $CI_PROJECT_DIR (GitLab) or
// $GITHUB_WORKSPACE, else the working directory. Absolute if the file lies outside, or where
// $JENKINS_URL is set, as Jenkins' plugin for attachments asks for. The file need not exist. To be
// freed; NULL when memory is short.
char *ci_path(const char *path);
