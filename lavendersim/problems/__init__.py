"""Outside problems enter; solutions, judged by their residuals, leave."""
