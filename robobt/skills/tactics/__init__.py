"""What the play set ``team`` agrees on: tasks, places, passes and marks."""
