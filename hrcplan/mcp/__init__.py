"""Tools for language models: hrcplan's commands over the Model Context Protocol."""
