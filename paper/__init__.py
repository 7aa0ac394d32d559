"""The tables of the paper, each as a function that returns the paper's figures beside ours."""
