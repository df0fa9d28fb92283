// None: the benchmark is cohesionless.
