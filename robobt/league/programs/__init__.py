"""Other teams' programs in our matches: started, served, watched and ended."""
