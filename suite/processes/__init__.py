"""What a process is to us: what it prints, its generators, its descendants, memory, cores."""
